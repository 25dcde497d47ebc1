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
    """A description of a Vulkan device."""

    index: int
    """The device's index in `Device.list()`."""
    name: str
    """The name that the device's driver reports."""
    type: str
    """The kind of the device: "discrete GPU", "integrated GPU", "virtual GPU", "CPU" or "other"."""
    driver: str
    """The driver's name and version."""
    uuid: str
    """A permanent identifier of 32 digits: "uuid:" followed by it selects the device. All lavapipe devices have the
    same one."""
    api_version: str
    """The Vulkan version that the device supports."""
    obstacles: tuple[str, ...] = ()
    """Reasons why promin cannot use the device; empty for a usable device."""
    lacks: tuple[str, ...] = ()
    """Optional features that the device lacks, and what promin does without them."""
    is_default: bool = False
    """True if it is the default device."""


class Device:
    """An open Vulkan device. Any number of Casters and Renderers on any threads may share it."""

    def __init__(self, selection: str | int | None = None, cache: bool = True) -> None:
        """Opens the device that `selection` names: an index of `Device.list()`, "uuid:" with a UUID, or a part of a
        device's name, in upper or lower case. Without a selection it opens a GPU, or a CPU if there is no GPU. Raises
        DeviceError if no device is usable or none matches; without any driver the message names the package with Mesa's
        drivers.

        cache: False neither keeps compiled kernels in `~/.cache/promin` nor reads them. Results have the same bits."""
        self._selection = _name(selection)
        self._cache = cache
        self._native = _promin.Device.open(self._selection, cache)

    @staticmethod
    def list() -> list[DeviceInfo]:
        """Returns all Vulkan devices that the loader finds; empty if there is no driver. Raises DeviceError if there is
        no loader."""
        return [DeviceInfo(**info) for info in _promin.list_devices()]

    @property
    def info(self) -> DeviceInfo:
        """The device's entry in `Device.list()`."""
        return DeviceInfo(**self._native.info())

    @property
    def choice(self) -> str:
        """The reason for the choice of this device, as a sentence."""
        return self._native.choice()

    @property
    def fingerprint(self) -> str:
        """Name and driver of the device. Together with promin's version they determine the bits of pictures and
        hits."""
        info = self.info
        return f"{info.name}, {info.driver}"

    def __repr__(self) -> str:
        return f"<promin.Device {self.fingerprint}>"

    def __reduce__(self) -> tuple[type[Device], tuple[str | None, bool]]:
        return type(self), (self._selection, self._cache)


DeviceLike = Union[Device, str, int, None]
"""A device, or an argument of `Device()`. None stands for the default device, which all users share."""


def find_device(device: DeviceLike) -> Device:
    """Returns the argument if it is a device, a device that this process has already opened with this name, or a new
    device."""
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
# Another thread may have held the lock at the fork.
os.register_at_fork(after_in_child=_renew_lock)
