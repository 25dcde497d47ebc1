# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""What is shown of a scene, and the rules of it; what is left open is decided as the command line does."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf
from operator import index
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from promin import _promin
from promin._errors import UsageError
from promin._records import Camera, Display, to_dict

CameraLike = Union[Camera, str, int, None]
"""A camera, or the name or number of one of the scene's; None: its first, or one that frames the scene."""

Size = Union[tuple[int, int], Sequence[int], int, str, None]
"""Width and height in pixels; a width; or a word of `promin render --size`: "640x480", "640", "x480", "hd"."""

Numbers = Union[Sequence[float], NDArray[Any]]
"""Three numbers."""

_ERROR_SPACES = _promin.list_choices()["error_in"]


@dataclass(frozen=True)
class View:
    """What of a scene is shown, and how well; the defaults are those of `promin render`."""

    # test_tables.py holds these words against the library's tables.

    camera: CameraLike = None
    """From where."""
    size: Size = None
    """Width and height in pixels, a width alone, "640x480" or "hd", "fullhd", "4k"; None: what the camera asks for, else
    a height of 720."""
    crop: tuple[int, int, int, int] | None = None
    """x0, y0, x1, y1: the pixels to trace, half-open."""
    spp: int = 8
    """Samples a pixel; 1 samples the centre."""
    quality: str | None = None
    """"draft", "normal", "high" or "best", in place of `spp` and `target_error`."""
    max_depth: int | None = None
    """Bounces; None: 5, or 8 with glass."""
    target_error: float | None = None
    """Each pixel takes samples until it claims to be this near (docs/model.md, "Error of a pixel"), in place of
    `spp`."""
    time_limit: float | str | None = None
    """Seconds, or a word as "20s" or "2min": the best picture that is complete by then, compilation included."""
    min_spp: int | None = None
    """Samples that each pixel takes with an error target, a power of two; None: 8, or 4 for a coarse target."""
    max_spp: int | None = None
    """The samples at which a pixel stops with an error target, a power of two; None: 256."""
    error_in: str = "linear"
    """What `target_error` is of: "linear" light, or the "display": what is shown, exposed, tone mapped and encoded as
    sRGB, by `Renderer.display`, whatever a file is saved with."""
    filter: str = "box"
    """"box", "tent", "gauss" or "blackman-harris"."""
    filter_width: float | None = None
    """In pixels; None: the filter's own."""
    depth: str = "ray"
    """How the AOV `depth` is measured: "ray" from the eye, or "plane" along the view."""
    debug_view: str = "full"
    """"full" is light; or "normals", "uv", "object", "primitive", "depth", "steps"."""
    shadows: bool = True
    """Whether lights cast shadows."""

    # What changes the camera, as the options of `promin render` of these names do.

    from_: str | None = None
    """"three-quarter", "front", "back", "left", "right", "top", "bottom" or "inside": shows all of the scene from
    there, whatever cameras it has."""
    fit: float | None = None
    """Share of the picture that such a view covers, 0.05 to 1; None: 0.85."""
    azimuth: float | None = None
    """Degrees by which the camera goes around the scene to the right."""
    elevation: float | None = None
    """Degrees by which it then rises over the scene."""
    roll: float | None = None
    """Degrees by which the picture then turns clockwise."""
    zoom: float | None = None
    """Magnifies the picture around its middle; None: 1."""
    eye: Numbers | None = None
    """Place of the eye, instead of the camera's."""
    look_at: Numbers | None = None
    """Point to look at."""
    direction: Numbers | None = None
    """Direction of view, instead of the camera's."""
    up: Numbers | str | None = None
    """Direction that is up in the scene or, where a camera is given, in its picture: a vector or "x", "y", "z", "-x",
    "-y", "-z"; None: +Y, or the camera's."""
    fov: float | None = None
    """Vertical field of view in degrees, instead of the camera's."""
    near: float | None = None
    """Distance before which nothing is drawn, instead of the camera's."""


def of_view(view: object) -> View:
    """The view itself. Raises UsageError for what is none."""
    if isinstance(view, View):
        return view
    raise UsageError(f"{view!r:.80} is no promin.View")


def change_view(view: View, given: Mapping[str, Any]) -> View:
    """The view with those of its fields that are given and not None. They take the place of fields that contradict
    them: numbers of samples that of a quality, a camera that of all that changes the view's own."""
    changes = {name: given[name] for name in FIELDS if given.get(name) is not None}
    for name in list(changes):
        changes = {**dict.fromkeys(_TAKES_PLACE_OF.get(name, ())), **changes}
    if "quality" in changes:
        beside = [name for name in _NUMBERS_OF_SAMPLES if name in changes]
        if beside:
            raise UsageError(f"quality and {beside[0]} contradict each other; leave one out")
        changes = {**{name: getattr(View, name) for name in _NUMBERS_OF_SAMPLES}, **changes}
    elif any(name in changes for name in _NUMBERS_OF_SAMPLES):
        changes["quality"] = None
    return dataclasses.replace(view, **changes)


FIELDS = tuple(field.name for field in dataclasses.fields(View))
POSE = FIELDS[FIELDS.index("from_") :]
"""The fields that change the camera."""
_TAKES_PLACE_OF = {
    "camera": POSE,
    "from_": ("camera", "eye", "look_at", "direction"),
    "fit": ("camera", "eye", "look_at"),
    "eye": ("from_", "fit"),
    "look_at": ("from_", "fit", "direction"),
    "direction": ("from_", "look_at"),
}
"""The fields that contradict a field."""

_VECTORS = {
    **dict.fromkeys(("eye", "look_at", "direction"), "three numbers"),
    "background": 'three numbers or a word as "environment"',
    "up": 'three numbers or a word as "z"',
}
"""What options with three numbers take."""

_NUMBERS_OF_SAMPLES = ("spp", "target_error", "time_limit")


def settle_quality(view: View) -> View:
    """The view with the numbers that its quality stands for."""
    if view.quality is None:
        return view
    for name in _NUMBERS_OF_SAMPLES:
        if getattr(view, name) != getattr(View, name):
            raise UsageError(f"quality and {name} contradict each other; leave one out")
    fields = _promin.read_quality(str(view.quality) or "-", str(view.debug_view) or "-")
    if fields["target_error"] is None:
        fields["error_in"] = view.error_in
    return dataclasses.replace(view, quality=None, **fields)


def shows_light(view: View) -> bool:
    return view.debug_view == View.debug_view


def has_target(view: View) -> bool:
    return view.target_error is not None or view.time_limit is not None


def begins_with_target(view: View) -> bool:
    """Whether the first picture has an error target: a time limit begins with one sample a pixel."""
    return view.target_error is not None and view.time_limit is None


def mode_of(view: View) -> dict[str, Any]:
    """What of the view is compiled in."""
    return {"debug_view": view.debug_view, "has_shadows": bool(view.shadows)}


def size_of(view: View) -> tuple[int, ...]:
    """In pixels; 0 where the camera decides."""
    if view.size is None:
        return (0, 0)
    if isinstance(view.size, str):
        return _promin.read_size(view.size or "-")
    if isinstance(view.size, (int, np.integer)):
        sides = _integers((view.size, 0), 2, "size")
        least = sides[0]
    else:
        sides = _integers(view.size, 2, "size")
        least = min(sides)
    if least < 1:
        raise UsageError(f"size is {view.size!r:.80}; give pixels, 1 or more each way")
    return sides


def option_words(name: str, value: object) -> list[str]:
    """The option of `promin render` that has a keyword's name, with the words of its value; no words where it is None.
    Raises UsageError where the value is neither a text nor as many numbers as the option takes."""
    if value is None:
        return []
    option = "--" + name.rstrip("_").replace("_", "-")
    try:
        is_text = isinstance(value, str)
        words = str(value).split() or ["-"] if is_text else [repr(float(x)) for x in np.ravel(np.asarray(value))]
    except (TypeError, ValueError):
        words = []
    count = 3 if name in _VECTORS else 1
    if any(word.startswith("--") for word in words) or (len(words) != count and not is_text):
        raise UsageError(f"{name} is {value!r:.80}; give {_VECTORS.get(name, 'a number')}")
    # A word alone may begin with a dash.
    return [f"{option}={words[0]}"] if len(words) == 1 else [option, *words]


def camera_words(view: View) -> list[str]:
    """The options of `promin render` that choose the view's camera and change it."""
    words = [] if view.camera is None or isinstance(view.camera, Camera) else [f"--camera={view.camera}"]
    return words + [word for name in POSE for word in option_words(name, getattr(view, name))]


def limit_of(view: View) -> float | None:
    """In seconds; None: there is none."""
    limit = view.time_limit
    if limit is None:
        return None
    if isinstance(limit, str):
        return _promin.read_time_limit(limit or "-")
    if isinstance(limit, (int, float)) and 0 < limit < inf:
        return float(limit)
    raise UsageError(f"time_limit is {limit!r:.80}; give a positive number of seconds")


def to_record(view: View, camera: dict[str, Any], shown: Display, default_max_depth: int) -> dict[str, Any]:
    """The view as the native module takes it, from a camera that it takes, shown like this."""
    size = _promin.choose_size(camera, size_of(view))
    if size is None:
        raise UsageError(
            f"the camera's aspect_ratio of {camera['aspect_ratio']!r:.80} gives no sensible width; give size"
        )
    crop = None if view.crop is None else _integers(view.crop, 4, "crop")
    width = _promin.default_width(str(view.filter)) if view.filter_width is None else view.filter_width
    _check_samples(view)
    asked = {
        "target_error": view.target_error,
        "time_limit": limit_of(view),
        "min_spp": view.min_spp,
        "max_spp": view.max_spp,
        "error_in": view.error_in,
    }
    return {
        "camera": camera,
        "size": size,
        "crop": None if crop is None else {"lo": crop[:2], "hi": crop[2:]},
        "samples_per_pixel": 1 if has_target(view) else view.spp,
        "error_target": _promin.error_target(asked, to_dict(shown)),
        "depth_kind": view.depth,
        "filter": view.filter,
        "filter_width": width,
        "max_depth": default_max_depth if view.max_depth is None else view.max_depth,
        "mode": mode_of(view),
    }


def check_shading(view: View, aovs: tuple[str, ...]) -> None:
    """A debug view is no light: it has no error and no background to leave out."""
    if shows_light(view):
        return
    for name, lacks in (("error", "error"), ("alpha", "background")):
        if name in aovs:
            raise UsageError(
                f'aovs with "{name}" and debug_view="{view.debug_view}" contradict each other: a debug view has no '
                f"{lacks}; leave one out"
            )


def _check_samples(view: View) -> None:
    """The rules of promin's options about samples."""
    if view.error_in not in _ERROR_SPACES:
        names = " or ".join(f'"{name}"' for name in _ERROR_SPACES)
        raise UsageError(f"error_in is {view.error_in!r:.80}; give {names}")
    if has_target(view):
        name = "time_limit" if view.target_error is None else "target_error"
        if isinstance(view.spp, (int, np.integer)) and view.spp not in (1, View.spp):
            raise UsageError(
                f"{name} and spp={view.spp} contradict each other; leave one out; min_spp and max_spp limit the samples"
            )
        return
    for name in ("min_spp", "max_spp", "error_in"):
        if getattr(view, name) != getattr(View, name):
            raise UsageError(f"{name} needs an error to aim at; give target_error as well")


def _integers(values: Any, count: int, what: str) -> tuple[int, ...]:
    try:
        result = tuple(index(value) for value in values)
    except TypeError:
        result = ()
    if len(result) != count or any(not 0 <= value < 2**32 for value in result):
        raise UsageError(f"{what} is {values!r:.80}; give {count} whole numbers of pixels")
    return result
