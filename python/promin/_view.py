# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Views of a scene and their rules. Open settings are chosen as on the command line."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf, isfinite
from operator import index
from typing import Any, Union

import numpy as np
from numpy.typing import NDArray

from promin import _promin
from promin._errors import UsageError
from promin._records import Camera, Display, to_dict

CameraLike = Union[Camera, str, int, None]
"""A camera, or the name or number of a camera of the scene. None stands for the scene's first camera, or for a camera
that frames the scene if it has none."""

Size = Union[tuple[int, int], Sequence[int], int, str, None]
"""A size: width and height in pixels, a width alone, or a value of `promin render --size`, such as "640x480", "640",
"x480" or "hd"."""

Numbers = Union[Sequence[float], NDArray[Any]]
"""Three numbers."""

INTEGRATORS = _promin.list_choices()["integrator"]
_ERROR_SPACES = _promin.list_choices()["error_in"]


@dataclass(frozen=True)
class View:
    """The camera, size, quality and mode of a picture. The defaults are those of `promin render`."""

    # test_tables.py compares the words in these docstrings with the library's tables.

    camera: CameraLike = None
    """The camera."""
    size: Size = None
    """Width and height in pixels, a width alone, "640x480" or "hd", "fullhd", "4k"; None: the size that the camera
    requests, else a height of 720."""
    crop: tuple[int, int, int, int] | None = None
    """The pixels to trace: x0, y0, x1, y1, without column x1 and row y1."""
    spp: int | None = None
    """Samples per pixel. A single sample is at the pixel's centre. None: 8, or 32 with the integrators "direct" and
    "path"."""
    quality: str | None = None
    """The quality, in place of `spp` and `target_error`: "draft", "normal", "high" or "best"."""
    max_depth: int | None = None
    """Largest number of bounces; None: 5, or 8 with glass."""
    seed: int = 0
    """The seed of the points of lights with a size, and of `target_error`, 0 to 4294967295. Each seed gives other
    noise."""
    target_error: float | None = None
    """The target error, in place of `spp`. Each pixel takes samples until its estimated error is at most this
    (docs/model.md, "Error of a pixel")."""
    time_limit: float | str | None = None
    """The time for the picture: seconds, or a text such as "20s" or "2min". promin makes the best picture that it can
    finish in this time, including compilation."""
    min_spp: int | None = None
    """Smallest number of samples per pixel with an error target, a power of two. None: 8, or 4 for a coarse target."""
    max_spp: int | None = None
    """Largest number of samples per pixel with an error target, a power of two. None: 256."""
    error_in: str = "linear"
    """The values whose error `target_error` limits: "linear" light, or "display", the values after `Renderer.display`
    has exposed, tone mapped and encoded the light as sRGB. The display of a saved file has no influence."""
    filter: str = "box"
    """The filter of a pixel's samples: "box", "tent", "gauss" or "blackman-harris"."""
    filter_width: float | None = None
    """Width of the filter in pixels; None: the filter's default."""
    depth: str = "ray"
    """The definition of the AOV `depth`: "ray" is the distance from the eye, "plane" the distance along the direction
    of view."""
    debug_view: str = "full"
    """The property that the picture shows: "full" for light, or "normals", "uv", "object", "primitive", "depth",
    "steps" or "occlusion"."""
    occlusion_distance: float = 0.0
    """Largest distance at which surfaces darken others in the debug view of occlusion and in the AOV
    `ambient_occlusion`; 0 is any distance."""
    shadows: bool = True
    """True if lights cast shadows."""
    integrator: str | None = None
    """The method that computes light: "whitted", or "direct", with which objects also block the light of the
    environment, or "path", with which surfaces also scatter light to other surfaces. None: "direct" with soft light
    and for scenes whose surfaces emit much light (docs/usage.md, "--integrator"), otherwise "whitted"."""

    # The following fields change the camera, as the options of `promin render` with the same names do.

    from_: str | None = None
    """The side from which the camera looks: "three-quarter", "front", "back", "left", "right", "top", "bottom" or
    "inside". The picture shows the whole scene from this side, and the scene's cameras are not used."""
    fit: float | None = None
    """Fraction of the picture that the scene covers if `from_` is given, 0.05 to 1; None: 0.85."""
    azimuth: float | None = None
    """Degrees by which the camera moves around the scene to the right; applied first."""
    elevation: float | None = None
    """Degrees by which the camera moves upwards around the scene; applied second."""
    roll: float | None = None
    """Degrees by which the picture rotates clockwise; applied last."""
    zoom: float | None = None
    """Factor by which the picture is magnified around its middle; None: 1."""
    eye: Numbers | None = None
    """Position of the eye, in place of the camera's."""
    look_at: Numbers | None = None
    """The point at which the camera looks."""
    direction: Numbers | None = None
    """Direction of view, in place of the camera's."""
    up: Numbers | str | None = None
    """The direction that points upwards in the scene or, if a camera is given, in its picture: a vector or "x", "y",
    "z", "-x", "-y", "-z"; None: +Y, or the camera's."""
    fov: float | None = None
    """Vertical field of view in degrees, in place of the camera's."""
    near: float | None = None
    """Distance of the near plane, in place of the camera's. Nothing nearer than this plane is drawn."""


def of_view(view: object) -> View:
    """Returns the argument if it is a View. Raises UsageError for other types."""
    if isinstance(view, View):
        return view
    raise UsageError(f"{view!r:.80} is not a promin.View")


def change_view(view: View, given: Mapping[str, Any]) -> View:
    """Returns the view with the fields of `given` that are not None. A given field replaces the fields that contradict
    it: a number of samples replaces the quality, and a camera replaces all fields that change the view's own camera."""
    changes = {name: given[name] for name in FIELDS if given.get(name) is not None}
    for name in list(changes):
        changes = {**dict.fromkeys(_TAKES_PLACE_OF.get(name, ())), **changes}
    if "quality" in changes:
        beside = [name for name in _NUMBERS_OF_SAMPLES if name in changes]
        if beside:
            raise UsageError(f"quality and {beside[0]} contradict each other; remove one of them")
        changes = {**{name: getattr(View, name) for name in _NUMBERS_OF_SAMPLES}, **changes}
    elif any(name in changes for name in _NUMBERS_OF_SAMPLES):
        changes["quality"] = None
    return dataclasses.replace(view, **changes)


FIELDS = tuple(field.name for field in dataclasses.fields(View))
POSE = FIELDS[FIELDS.index("from_") :]
"""The names of the fields that change the camera."""
_TAKES_PLACE_OF = {
    "camera": POSE,
    "from_": ("camera", "eye", "look_at", "direction"),
    "fit": ("camera", "eye", "look_at"),
    "eye": ("from_", "fit"),
    "look_at": ("from_", "fit", "direction"),
    "direction": ("from_", "look_at"),
}
"""For each field, the fields that contradict it."""

_VECTORS = {
    **dict.fromkeys(("eye", "look_at", "direction"), "three numbers"),
    "background": 'three numbers or a word as "environment"',
    "up": 'three numbers or a word as "z"',
}
"""Values that options with three numbers accept."""

_NUMBERS_OF_SAMPLES = ("spp", "target_error", "time_limit")


def settle_quality(view: View) -> View:
    """Returns the view with the settings of its quality, or with the usual number of samples. Both depend on its
    integrator."""
    given = [name for name in _NUMBERS_OF_SAMPLES if getattr(view, name) is not None]
    if given and view.quality is None:
        return view
    if given:
        raise UsageError(f"quality and {given[0]} contradict each other; remove one of them")
    quality = None if view.quality is None else str(view.quality)
    fields = _promin.read_quality(
        to_spec({"quality": quality, "shading": str(view.debug_view), "integrator": view.integrator})
    )
    if fields["target_error"] is None:
        fields["error_in"] = view.error_in
    return dataclasses.replace(view, quality=None, **fields)


def shows_light(view: View) -> bool:
    return view.debug_view == View.debug_view


def has_target(view: View) -> bool:
    return view.target_error is not None or view.time_limit is not None


def begins_with_target(view: View) -> bool:
    """Returns whether the first picture has an error target. With a time limit it has none: it has one sample per
    pixel."""
    return view.target_error is not None and view.time_limit is None


def mode_of(view: View) -> dict[str, Any]:
    """Returns the settings of the view that are compiled into the pipeline."""
    integrator = INTEGRATORS[0] if view.integrator is None else view.integrator
    return {"debug_view": view.debug_view, "has_shadows": bool(view.shadows), "integrator": integrator}


def size_of(view: View) -> tuple[int, ...]:
    """Returns the size in pixels; a side of 0 is determined by the camera."""
    if view.size is None:
        return (0, 0)
    if isinstance(view.size, str):
        return _promin.read_size(view.size)
    if isinstance(view.size, (int, np.integer)):
        sides = _integers((view.size, 0), 2, "size")
        least = sides[0]
    else:
        sides = _integers(view.size, 2, "size")
        least = min(sides)
    if least < 1:
        raise UsageError(f"size is {view.size!r:.80}; give the width and height in pixels, from 1")
    return sides


def member_of(name: str, value: object) -> object:
    """Returns a value as it is written in a specification (docs/usage.md, "Specifications"): a text, a truth value, a
    number or a list of three. Raises UsageError if the value is neither a text nor as many numbers as the member
    accepts."""
    if isinstance(value, (str, bool)):
        return value
    try:
        numbers = [float(x) for x in np.ravel(np.asarray(value))]
    except (TypeError, ValueError):
        numbers = []
    if len(numbers) != (3 if name in _VECTORS else 1):
        raise UsageError(f"{name} is {value!r:.80}; give {_VECTORS.get(name, 'a number')}")
    # JSON has no numbers that are not finite; as texts they are refused with the range of the member.
    written = [x if isfinite(x) else str(x) for x in numbers]
    return written if name in _VECTORS else written[0]


def to_spec(members: Mapping[str, object]) -> str:
    """Returns the specification of pictures with these members, as JSON; members without a value are left out."""
    given = {name.rstrip("_"): member_of(name, value) for name, value in members.items() if value is not None}
    return json.dumps({"promin_render_spec": 1, **given})


def pose_of(view: View) -> dict[str, object]:
    """Returns the members of a specification for the view's camera, except a Camera."""
    named = None if view.camera is None or isinstance(view.camera, Camera) else str(view.camera)
    return {"camera": named, **{name: getattr(view, name) for name in POSE}}


def camera_spec(view: View) -> str:
    """Returns the specification of the view's camera."""
    return to_spec(pose_of(view))


def limit_of(view: View) -> float | None:
    """Returns the time limit in seconds; None if there is none."""
    limit = view.time_limit
    if limit is None:
        return None
    if isinstance(limit, str):
        return _promin.read_time_limit(limit)
    if isinstance(limit, (int, float)) and 0 < limit < inf:
        return float(limit)
    raise UsageError(f"time_limit is {limit!r:.80}; give a positive number of seconds")


def to_record(view: View, camera: dict[str, Any], shown: Display, default_max_depth: int) -> dict[str, Any]:
    """Returns the view as a dict for the native module, with this camera and display."""
    size = _promin.choose_size(camera, size_of(view))
    if size is None:
        raise UsageError(
            f"the camera's aspect_ratio of {camera['aspect_ratio']!r:.80} is too extreme to compute the width of the "
            "picture; give size"
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
        "seed": view.seed,
        "occlusion_distance": view.occlusion_distance,
        "mode": mode_of(view),
    }


def check_shading(view: View, aovs: tuple[str, ...]) -> None:
    """Raises UsageError for options that need light: a debug view has no error estimate and no alpha."""
    if shows_light(view):
        return
    for name, lacks in (("error", "error"), ("alpha", "background")):
        if name in aovs:
            raise UsageError(
                f'aovs with "{name}" and debug_view="{view.debug_view}" contradict each other: a debug view has no '
                f"{lacks}; remove one of them"
            )


def _check_samples(view: View) -> None:
    """Raises UsageError if the view breaks a rule of the options about samples."""
    if view.error_in not in _ERROR_SPACES:
        names = " or ".join(f'"{name}"' for name in _ERROR_SPACES)
        raise UsageError(f"error_in is {view.error_in!r:.80}; give {names}")
    if has_target(view):
        name = "time_limit" if view.target_error is None else "target_error"
        if isinstance(view.spp, (int, np.integer)) and view.spp not in (1, None):
            raise UsageError(
                f"{name} and spp={view.spp} contradict each other; remove one of them; min_spp and max_spp limit the "
                "samples"
            )
        return
    for name in ("min_spp", "max_spp", "error_in"):
        if getattr(view, name) != getattr(View, name):
            raise UsageError(f"{name} needs a target error; give target_error as well")


def _integers(values: Any, count: int, what: str) -> tuple[int, ...]:
    try:
        result = tuple(index(value) for value in values)
    except TypeError:
        result = ()
    if len(result) != count or any(not 0 <= value < 2**32 for value in result):
        raise UsageError(f"{what} is {values!r:.80}; give {count} whole numbers of pixels")
    return result
