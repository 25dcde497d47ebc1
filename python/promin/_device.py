# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Vulkan devices."""

from __future__ import annotations

import os
import threading
import weakref
from dataclasses import dataclass
from typing import Union

from promin import _promin
from promin._errors import UsageError


@dataclass(frozen=True)
class DeviceInfo:
    """A Vulkan device in words."""

    index: int
    """Its place in `Device.list()`."""
    name: str
    """As its driver calls it."""
    type: str
    """"discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other"."""
    driver: str
    """The driver's name and version."""
    uuid: str
    """By which it is found again: "uuid:" with these 32 digits names it. Lavapipes all have the same."""
    api_version: str
    """The version of Vulkan that it speaks."""
    obstacles: tuple[str, ...] = ()
    """Why it cannot be used; empty for a usable one."""
    lacks: tuple[str, ...] = ()
    """Optional features that it does not have, and what promin does without them."""
    is_default: bool = False
    """Whether it is taken where none is named."""


class Device:
    """An open Vulkan device, which any number of Casters and Renderers share, on any threads."""

    def __init__(self, selection: str | int | None = None) -> None:
        """Opens the device that `selection` names: an index of `Device.list()`, "uuid:" with a UUID, or a part of a
        name, case ignored; without one a GPU before a CPU. Raises DeviceError where none is usable or none matches, and
        names the package with Mesa's drivers where there is no driver at all."""
        self._selection = _name(selection)
        self._native = _promin.Device.open(self._selection)

    @staticmethod
    def list() -> list[DeviceInfo]:
        """Every Vulkan device that the loader finds; empty where there is no driver. Raises DeviceError where there is
        not even a loader."""
        return [DeviceInfo(**info) for info in _promin.list_devices()]

    @property
    def info(self) -> DeviceInfo:
        """What `Device.list()` tells of it."""
        return DeviceInfo(**self._native.info())

    @property
    def choice(self) -> str:
        """Why it was picked, a sentence."""
        return self._native.choice()

    @property
    def fingerprint(self) -> str:
        """Name and driver: what decides about the bits of pictures and hits, beside promin's version."""
        info = self.info
        return f"{info.name}, {info.driver}"

    def __repr__(self) -> str:
        return f"<promin.Device {self.fingerprint}>"

    def __reduce__(self) -> tuple[type[Device], tuple[str | None]]:
        return type(self), (self._selection,)


DeviceLike = Union[Device, str, int, None]
"""A device, or what `Device()` takes; None is the default device, which is opened once for all that use it."""


def find_device(device: DeviceLike) -> Device:
    """The device itself, or one that this process has open by this name, or a new one."""
    if isinstance(device, Device):
        return device
    name = _name(device)
    key = (os.getpid(), name)
    with _opening:
        opened = _opened.get(key)
        if opened is None:
            opened = _opened[key] = Device(name)
        return opened


def _name(selection: object) -> str | None:
    if selection is None or isinstance(selection, str):
        return selection
    if isinstance(selection, int) and not isinstance(selection, bool):
        return str(selection)
    raise UsageError(f"device is {selection!r}; give a promin.Device, a part of a name, an index or None")


def _renew_lock() -> None:
    global _opening
    _opening = threading.Lock()


_opening = threading.Lock()
_opened: weakref.WeakValueDictionary[tuple[int, str | None], Device] = weakref.WeakValueDictionary()
# Another thread may have held it at the fork.
os.register_at_fork(after_in_child=_renew_lock)
