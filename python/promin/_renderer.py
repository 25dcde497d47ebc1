# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Rendering pictures of a scene."""

from __future__ import annotations

import functools
import inspect
import os
import threading
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from operator import index
from pathlib import Path
from typing import Any, TypeVar, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from promin import _promin
from promin._caster import Progress
from promin._device import Device, DeviceLike, find_device
from promin._errors import InputError, UsageError
from promin._frame import Frame, to_mattes
from promin._records import Camera, Display, Environment, Light, Material, from_dict, suggest, to_dict
from promin._scene import (
    REMAKES,
    Scene,
    SceneLike,
    move_camera,
    move_light,
    replace_one,
    split_transforms,
    to_scene,
    to_world,
)
from promin._view import (
    FIELDS,
    CameraLike,
    Numbers,
    Size,
    View,
    begins_with_target,
    camera_spec,
    change_view,
    check_shading,
    has_target,
    limit_of,
    mode_of,
    of_view,
    pose_of,
    settle_quality,
    shows_light,
    size_of,
    to_record,
    to_spec,
)

_ASPECT_RATIO = 16 / 9
"""Aspect ratio of the camera that frames a scene if no size is given, the same as in `promin render`
(test_tables.py)."""
_NO_ID = np.uint32(2**32 - 1)
"""The value of the AOV `object` on a miss."""
_MOST_STOPS = 64
"""The largest exposure in stops, the same as in `promin render`."""


Background = Union[Sequence[float], str, None]
"""A background in one of the forms of `promin render --background`: three sRGB numbers from 0 to 1, "white", "#80a0ff",
"linear:0.2,0.4,1" or "environment"."""

Function = TypeVar("Function", bound=Callable[..., Any])


def names_keywords(function: Function) -> Function:
    """Wraps a function so that its TypeError for an unknown keyword suggests a similar one."""
    known = [name for name in inspect.signature(function).parameters if name not in ("self", "view")]

    @functools.wraps(function)
    def call(*values: Any, **keywords: Any) -> Any:
        for name in keywords:
            if name not in known and name != "view":
                if name in FIELDS:
                    cure = f"give it to render, or in view=promin.View({name}=...)"
                    raise TypeError(f"{_name_of(function)}() has no keyword {name!r}; {cure}")
                if name in _ELSEWHERE:
                    raise TypeError(f"{_name_of(function)}() has no keyword {name!r}; {_ELSEWHERE[name]}")
                meant = _OTHER_KEYWORDS.get(name) or _promin.find_option(name.replace("_", "-")).replace("-", "_")
                cure = f"did you mean {meant}?" if meant in known else suggest(name, known)
                raise TypeError(f"{_name_of(function)}() has no keyword {name!r}; {cure}")
        return function(*values, **keywords)

    return call  # type: ignore[return-value]


def _name_of(function: Callable[..., Any]) -> str:
    return function.__qualname__.removesuffix(".__init__")


_ELSEWHERE = {
    **dict.fromkeys(("alpha", "transparent"), 'give aovs=("alpha",)'),
    **dict.fromkeys(("root", "strict", "variant"), "promin.Scene.load(file, ...) has it"),
    **dict.fromkeys(("dither", "tone_mapping"), "frame.save(file, promin.Display(...)) has it"),
    "lights_off": "switch a light off by scene.set_light(0, is_on=False)",
    "look": "a point to look at is look_at, a direction of view is direction",
    "output": "save what is returned: frame.save(file)",
}
"""Hints for options of the programs that these functions have no keyword for."""
_OTHER_KEYWORDS = {
    "aov": "aovs",
    "framing": "from_",
    "height": "size",
    "shading": "debug_view",
    "width": "size",
}
"""Keywords whose names differ from the names of the programs' options."""


@dataclass(frozen=True)
class _Opened:
    """A native renderer with its device."""

    device: Device
    native: _promin.Renderer
    lit: _promin.Scene
    """The scene with its lights."""
    display: dict[str, Any]
    """The display transform of its pictures."""
    aovs: tuple[str, ...]
    """The AOVs of the renderer's pictures."""


class Renderer:
    """Renders pictures of a scene on a device.

    The constructor lights the scene, builds a tree and compiles kernels. The scene may change afterwards; the Renderer
    keeps its own snapshot. The rules of a Caster for threads, Ctrl-C, pickling and forks apply to a Renderer too."""

    _opened: _Opened | None

    @names_keywords
    def __init__(
        self,
        scene: SceneLike,
        device: DeviceLike = None,
        *,
        aovs: Iterable[str] = (),
        view: View = View(),
        light: str = "auto",
        background: Background = None,
        environment: str | os.PathLike[str] | None = None,
        environment_rotation: float | None = None,
        environment_intensity: float | None = None,
        light_rotation: float | None = None,
        ground: bool | None = None,
        exposure: float | str = "auto",
        builder: str = "sah",
        bvh: str | os.PathLike[str] | None = None,
        instances: str = "auto",
        texture_memory: int = 512 << 20,
        expected_samples: int | None = None,
        progress: Progress = None,
    ) -> None:
        """aovs: the AOVs of the pictures, with the names of include/promin/aovs.h: "depth", "normal", "object", ...,
        and "cryptomatte" (see Frame.matte). `render` may request other AOVs; the tree is then built again. scene: a
        Scene, or the path of its file. view: the default view of `render`; the constructor compiles the kernels for it.
        If this view frames the scene, the light that is added and the ground stand on its `up`. light: the light that
        is added to a scene without light: "auto", "studio", "headlight", "none", "soft" or "fill". The soft light is
        the studio with soft shadows of its lamps and its sky, and with a ground. The fill is a weaker studio without
        its directional light. "auto" chooses it for a scene that its own surfaces light strongly, if the view's
        integrator is not "whitted". Another integrator of `render` does not change the light. ground: True if a ground
        under the scene shows its shadow, False if not; None: only with soft light. background: the background, as in
        `promin render --background`. Three sRGB numbers from 0 to 1, a name such as "white", or "#80a0ff" are a colour
        that pictures show exactly. "linear:0.2,0.4,1" is light, which is exposed and tone mapped. "environment" shows
        the environment that lights the scene. None: the scene's background, or a grey gradient. environment: the file
        of an equirectangular panorama, which replaces the scene's sky. environment_rotation: degrees by which the sky
        is rotated about its `up`, from +Z towards +X. light_rotation: the same rotation for the sky and the directional
        lights. environment_intensity: factor of the sky's radiance. exposure: stops by which pictures are displayed
        brighter, -64 to 64; "auto": an exposure that suits the scene's light, 0 for most scenes. texture_memory: the
        largest number of bytes for textures. expected_samples: the approximate number of samples of all pixels of all
        pictures together; if it is small, kernels are used that compile faster and trace slower, with the same bits;
        None: a large number. The other arguments are those of a Caster. Raises UsageError, InputError, DeviceError,
        RunError, Cancelled."""
        self._scene = to_scene(scene).snapshot()
        self._chosen = device
        self._usual_integrator = self._scene.native().usual_integrator(str(light))
        # The light stands on the view's `up`, unless a Camera replaces the scene's framing.
        self._view = of_view(view)
        integrator = self._usual_integrator if self._view.integrator is None else str(self._view.integrator)
        self._light, self._lit_for = str(light), integrator
        framing = {} if isinstance(self._view.camera, Camera) else pose_of(self._view)
        self._surroundings = to_spec(
            {
                **framing,
                "background": background,
                "environment_rotation": environment_rotation,
                "environment_intensity": environment_intensity,
                "light_rotation": light_rotation,
                "ground": None if ground is None else bool(ground),
            }
        )
        self._panorama = _panorama_of(environment)
        self._has_background = background is not None
        self._exposure = _stops_of(exposure)
        self._builder = str(builder)
        self._bvh = None if bvh is None else os.fsdecode(bvh)
        self._instances = str(instances)
        self._texture_memory = texture_memory
        self._expected_samples = None if expected_samples is None else _count(expected_samples, "expected_samples")
        self._aovs = _names(aovs)
        self._check_background(self._aovs)
        self._changes: dict[str, Any] = {}
        self._make_private()
        self._open(progress=progress)

    @property
    def scene(self) -> Scene:
        """The scene as it was when the Renderer was created."""
        return self._scene

    @property
    def device(self) -> Device:
        """The device that the renderer runs on."""
        return self._open().device

    @property
    def setup(self) -> dict[str, Any]:
        """The cost of construction. The keys are the names of include/promin/setup_stats.h."""
        return self._open().native.setup()

    @property
    def lights(self) -> list[Light]:
        """Copies of the lights, including the lights that the Renderer added."""
        lights = self._changes.get("lights")
        return list(lights) if lights is not None else [self._back(from_dict(Light, r)) for r in self._lit().lights()]

    @property
    def materials(self) -> list[Material]:
        """Copies of the materials, as the Renderer uses them."""
        materials = self._changes.get("materials")
        return list(materials) if materials is not None else [from_dict(Material, r) for r in self._lit().materials()]

    @property
    def environment(self) -> Environment:
        """Ambient light, background and sky, including those that the Renderer added."""
        environment: Environment | None = self._changes.get("environment")
        return environment if environment is not None else from_dict(Environment, self._lit().environment())

    @property
    def display(self) -> Display:
        """The transform with which 8-bit pictures of the scene are displayed."""
        shown = from_dict(Display, self._open().display)
        return shown if self._exposure is None else replace(shown, exposure_ev=self._exposure)

    def camera(self, camera: CameraLike = None, aspect_ratio: float = _ASPECT_RATIO) -> Camera:
        """Returns the camera that pictures have for this argument; None stands for the camera of the Renderer's view.
        dataclasses.replace changes the result. aspect_ratio: the ratio of the picture in which the scene is framed.
        Raises UsageError if the scene has no camera of this name or number."""
        if isinstance(camera, Camera):
            return camera
        record = self._choose_camera(change_view(self._view, {"camera": camera}), None, aspect_ratio)
        chosen: Camera = self._back(from_dict(Camera, record))
        return chosen

    def _choose_camera(self, view: View, sides: tuple[int, ...] | None, aspect_ratio: float) -> dict[str, Any]:
        """Returns the camera's record for the native module. sides: the size of the picture; None if it is unknown."""
        given = None
        if isinstance(view.camera, Camera):
            given = move_camera(view.camera, self._scene.native_center)
        return self._scene.native().choose_camera(camera_spec(view), given, sides, float(aspect_ratio))

    @names_keywords
    def render(
        self,
        view: View | None = None,
        *,
        aovs: Iterable[str] | None = None,
        next_scene: Scene | None = None,
        next_camera: CameraLike = None,
        progress: Progress = None,
        camera: CameraLike = None,
        size: Size = None,
        crop: tuple[int, int, int, int] | None = None,
        spp: int | None = None,
        quality: str | None = None,
        max_depth: int | None = None,
        seed: int | None = None,
        target_error: float | None = None,
        time_limit: float | str | None = None,
        min_spp: int | None = None,
        max_spp: int | None = None,
        error_in: str | None = None,
        filter: str | None = None,
        filter_width: float | None = None,
        depth: str | None = None,
        debug_view: str | None = None,
        occlusion_distance: float | None = None,
        shadows: bool | None = None,
        integrator: str | None = None,
        from_: str | None = None,
        fit: float | None = None,
        azimuth: float | None = None,
        elevation: float | None = None,
        roll: float | None = None,
        zoom: float | None = None,
        eye: Numbers | None = None,
        look_at: Numbers | None = None,
        direction: Numbers | None = None,
        up: Numbers | str | None = None,
        fov: float | None = None,
        near: float | None = None,
    ) -> Frame:
        """Renders one picture. view: None is the Renderer's own view; further keywords replace its fields. aovs: None
        selects the Renderer's own AOVs. `promin render` with the same scene file and options writes a picture with the
        same bits.

        The AOV "motion" is the movement until the next frame. next_scene: the scene of that frame, which has the same
        objects in another pose (Scene.at). next_camera: its camera, or the name or number of a camera of next_scene.
        None: the scene or the camera does not change.

        Raises UsageError for arguments that break the rules of include/promin/view.h or contradict each other,
        InputError if next_scene has other objects, RunError, Cancelled."""
        given = locals()  # each field of a view is a keyword of its name
        whole = self._settled(change_view(self._view if view is None else of_view(view), given))
        names = self._aovs if aovs is None else _names(aovs)
        check_shading(whole, names)
        self._check_background(names)
        if ("motion" in names) != (next_scene is not None or next_camera is not None):
            raise UsageError('the AOV "motion" and next_scene or next_camera need each other; give both or neither')
        opened = self._open(names, whole, progress)
        record, shown = self._describe_view(whole)
        nothing = ""
        if not self._changes.keys() & {"pose", "transforms"}:
            nothing = self._scene.native().describe_empty_picture(record["camera"], *record["size"])
        if nothing:
            warnings.warn(nothing, stacklevel=3)
        path = self._scene.path
        result = opened.native.render(
            record,
            limit_of(whole),
            to_dict(shown),
            "" if path is None else Path(path).name,
            opened.lit,
            opened.lit if next_scene is None else to_scene(next_scene).native(),
            self._choose_next_camera(next_scene, next_camera, record),
            progress,
        )
        unlit = result["aovs"].get("unlit")
        placement = None
        if record["crop"] is not None:
            placement = (record["crop"]["lo"], record["size"])
        return Frame(
            rgb=result["rgb"],
            aovs={**self._finish(result["aovs"], names), **to_mattes(result["cryptomatte"])},
            metadata=result["metadata"],
            display=shown,
            error=result["error"],
            rays=result["rays"],
            trace_ms=result["trace_ms"],
            unlit=unlit,
            placement=placement,
        )

    def update(
        self,
        *,
        lights: Iterable[Light] | None = None,
        materials: Iterable[Material] | None = None,
        environment: Environment | None = None,
        time: float | None = None,
        animation: str | int | Sequence[str | int] | None = 0,
        loop: bool = False,
        transforms: Mapping[int, ArrayLike] | None = None,
    ) -> None:
        """Changes the scene for all later pictures: replaces all lights, all materials or the environment, shows
        another pose, or moves objects. The number of materials must stay the same.

        time, animation, loop: the pose, like the arguments of Scene.at; None leaves the pose as it is. Lights,
        materials and objects that `update` has replaced or moved do not move with poses. transforms: new transforms
        (4, 4) by the objects' numbers, like those of Scene.add_instances. All other objects stay. Instances
        (docs/instances.md) move in milliseconds; to move other objects, the tree is built again. Framing, exposure, and
        the light and the ground that the Renderer added do not change, because they belong to the scene of the
        constructor.

        Raises UsageError and InputError for invalid arguments, and then changes nothing."""
        new: dict[str, Any] = {}
        moved = {} if transforms is None else self._scene.native_transforms(transforms)
        if time is not None:
            new["pose"] = self._scene.at(time, animation, loop=loop)
        if lights is not None:
            new["lights"] = _all_of(lights, Light)
        if materials is not None:
            new["materials"] = _all_of(materials, Material)
        if environment is not None:
            new["environment"] = _all_of([environment], Environment)[0]
        with self._lock:
            if "pose" in new:
                self._pose({**self._changes, **new, "transforms": self._moved(moved)})
                return
            native = self._open().native
            applied: list[str] = []
            try:
                for name, value in new.items():
                    applied.append(name)
                    self._apply(native, name, value)
                if moved:
                    new["transforms"] = self._moved(moved)
                    if not self._move(native, moved):
                        self._remake({**self._changes, **new})
            except BaseException:
                self._take_back(native, applied)
                raise
            self._changes.update(new)

    def _pose(self, changes: dict[str, Any]) -> None:
        """Shows the pose of `changes`, and then makes all other changes."""
        opened = self._open()
        try:
            opened.native.set_pose(changes["pose"].native().lit_like(opened.lit))
            for name, value in changes.items():
                if name not in ("pose", "transforms"):
                    self._apply(opened.native, name, value)
            if not self._move(opened.native, changes["transforms"]):
                self._remake(changes)
        except BaseException:
            # The next use makes the renderer again.
            self._opened = None
            raise
        self._changes = changes

    def _moved(self, transforms: dict[int, NDArray[np.float64]]) -> dict[int, NDArray[np.float64]]:
        """Returns the transforms of all objects that have moved so far."""
        return {**self._changes.get("transforms", {}), **transforms}

    def _move(self, native: _promin.Renderer, transforms: dict[int, NDArray[np.float64]]) -> bool:
        """Moves objects of the native renderer. Returns False if that needs a new tree."""
        try:
            native.set_transforms(*split_transforms(transforms))
        except InputError as error:
            if any(problem.code not in REMAKES for problem in error.problems):
                raise
            return False
        return True

    def _remake(self, changes: dict[str, Any]) -> None:
        """Replaces the native renderer by one with these changes."""
        opened = self._open()
        self._opened = self._make(opened.aovs, self._settled(self._view), None, changes)

    def set_material(self, material: str | int, new: Material | None = None, **fields: Any) -> None:
        """Changes a material in all later pictures, without building a tree. The arguments are those of
        Scene.set_material."""
        self.update(materials=replace_one(self.materials, material, _one_of(new, Material), fields, "material"))

    def set_light(self, light: str | int, new: Light | None = None, **fields: Any) -> None:
        """Changes a light in all later pictures, as set_material does with a material."""
        self.update(lights=replace_one(self.lights, light, _one_of(new, Light), fields, "light"))

    def _check_background(self, aovs: tuple[str, ...]) -> None:
        if self._has_background and "alpha" in aovs:
            raise UsageError(
                'background and the AOV "alpha", which removes it, contradict each other; remove one of them'
            )

    def _describe_view(self, view: View) -> tuple[dict[str, Any], Display]:
        """Returns the view for the native module, and the display transform of its picture."""
        camera = self._choose_camera(view, size_of(view), _ASPECT_RATIO)
        shown = self.display if shows_light(view) else Display()
        return to_record(view, camera, shown, self._lit().default_max_depth()), shown

    def _choose_next_camera(
        self, next_scene: Scene | None, next_camera: CameraLike, record: dict[str, Any]
    ) -> dict[str, Any]:
        """Returns the camera of the frame after the picture of this view, for the native module."""
        if next_camera is None:
            camera: dict[str, Any] = record["camera"]
            return camera
        scene = self._scene if next_scene is None else to_scene(next_scene)
        given = None
        if isinstance(next_camera, Camera):
            given = move_camera(next_camera, scene.native_center)
        return scene.native().choose_camera(camera_spec(View(camera=next_camera)), given, record["size"], _ASPECT_RATIO)

    def _settled(self, view: View) -> View:
        """Returns the view with an integrator and a number of samples or an error: its own, or those that suit the
        light of the scene."""
        integrator = self._usual_integrator if view.integrator is None else view.integrator
        return settle_quality(replace(view, integrator=integrator))

    def _finish(self, aovs: dict[str, NDArray[Any]], names: tuple[str, ...]) -> dict[str, NDArray[Any]]:
        """Returns the AOVs of these names. Positions are in world coordinates."""
        if self._moves(names):
            is_hit = (aovs["object"] != _NO_ID)[..., np.newaxis]
            aovs["position"] = np.where(is_hit, aovs["position"] + self._scene.native_center, 0.0)
        return {name: values for name, values in aovs.items() if name in names}

    # The native renderer, which is created at its first use.

    def _open(
        self, aovs: tuple[str, ...] | None = None, view: View | None = None, progress: Progress = None
    ) -> _Opened:
        """Returns an open renderer whose pictures have these AOVs; None accepts any. view: the view of the picture that
        will be rendered; None: the Renderer's own view."""
        opened = self._opened
        if opened is None or aovs not in (None, opened.aovs):
            with self._lock:
                opened = self._opened
                if opened is None or aovs not in (None, opened.aovs):
                    names = self._aovs if aovs is None else aovs
                    opened = self._make(names, view or self._settled(self._view), progress)
                    self._opened = opened
        # No lock is taken if everything exists: a thread that changes the scene holds the lock while a picture is
        # traced, and the progress callback of this picture may read the lights.
        return opened

    def _make(
        self, aovs: tuple[str, ...], view: View, progress: Progress, changes: dict[str, Any] | None = None
    ) -> _Opened:
        device = find_device(self._chosen)
        lit, display = self._scene.native().lit(self._light, self._lit_for, self._surroundings, self._panorama)
        changes = dict(self._changes if changes is None else changes)
        transforms = changes.pop("transforms", {})
        posed = changes.pop("pose", None)
        shown = lit if posed is None else posed.native().lit_like(lit)
        if transforms:
            shown = shown.moved(*split_transforms(transforms))
        unasked = {"object"} if self._moves(aovs) else set()
        if lit.mixes_unlit():
            unasked.add("unlit")
        native = _promin.Renderer(
            device._native,
            shown,
            sorted({*aovs, *unasked}),
            self._builder,
            self._bvh,
            self._instances,
            begins_with_target(view),
            mode_of(view),
            self._expected_samples,
            self._texture_memory,
            progress,
        )
        for name, value in changes.items():
            self._apply(native, name, value)
        return _Opened(device, native, lit, display, aovs)

    def _moves(self, aovs: tuple[str, ...]) -> bool:
        """Returns whether positions must be moved by the scene's center. The AOV `object` is then needed too, because a
        position of 0 may be a miss or a hit at the center."""
        return "position" in aovs and bool(self._scene.native_center.any())

    def _lit(self) -> _promin.Scene:
        return self._open().lit

    def _apply(self, native: _promin.Renderer, name: str, value: Any) -> None:
        if name == "lights":
            native.set_lights([move_light(light, self._scene.native_center) for light in value])
        elif name == "materials":
            native.set_materials([to_dict(material) for material in value])
        else:
            native.set_environment(to_dict(value))

    def _take_back(self, native: _promin.Renderer, names: Iterable[str]) -> None:
        """Restores the named values in the native renderer. If that fails, the next use makes another renderer."""
        lit = self._lit()
        try:
            for name in names:
                if name in self._changes:
                    self._apply(native, name, self._changes[name])
                elif name == "lights":
                    # The records are not converted to the world and back, because that would round them.
                    native.set_lights([to_dict(from_dict(Light, record)) for record in lit.lights()])
                elif name == "materials":
                    native.set_materials([to_dict(from_dict(Material, record)) for record in lit.materials()])
                else:
                    native.set_environment(to_dict(from_dict(Environment, lit.environment())))
        except BaseException:
            self._opened = None
            raise

    def _back(self, record: Any) -> Any:
        """Returns a camera or light of the native scene in world coordinates."""
        return to_world(record, self._scene.native_center)

    def _make_private(self) -> None:
        """Creates the members that are not pickled: the native objects, and the lock that protects them."""
        self._lock = threading.RLock()
        self._opened = None

    def __getstate__(self) -> dict[str, Any]:
        state = {key: value for key, value in self.__dict__.items() if key not in ("_lock", "_opened")}
        return {**state, "_changes": dict(self._changes)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._make_private()


def _names(aovs: Iterable[str]) -> tuple[str, ...]:
    if isinstance(aovs, str):
        raise UsageError(f"aovs is {aovs!r}; give a tuple of names")
    return tuple(sorted({str(name) for name in aovs}))


def _panorama_of(file: str | os.PathLike[str] | None) -> str | None:
    if file is None:
        return None
    if isinstance(file, (str, os.PathLike)):
        # The path is absolute, because a process that unpickles the Renderer may have another current folder.
        return os.path.abspath(os.fsdecode(file))
    raise UsageError(f"environment is {file!r:.80}; give a panorama's file, or assign to scene.environment")


def _stops_of(exposure: float | str) -> float | None:
    """Returns the exposure in stops; None if the scene determines it."""
    if exposure == "auto":
        return None
    stops = float(exposure) if isinstance(exposure, (int, float, np.number)) else inf
    if -_MOST_STOPS <= stops <= _MOST_STOPS:
        return stops
    raise UsageError(f'exposure is {exposure!r:.80}; give stops from -{_MOST_STOPS} to {_MOST_STOPS}, or "auto"')


def _one_of(record: Any, kind: type[Any]) -> Any:
    """Returns the record, or None if there is none."""
    return None if record is None else _all_of([record], kind)[0]


def _all_of(records: Iterable[Any], kind: type[Any]) -> list[Any]:
    result = list(records)
    for record in result:
        if not isinstance(record, kind):
            raise UsageError(f"{record!r:.80} is not a promin.{kind.__name__}")
    return result


def _count(value: object, what: str) -> int:
    try:
        result = index(value)  # type: ignore[arg-type]
    except TypeError:
        result = -1
    if not 0 <= result < 2**64:
        raise UsageError(f"{what} is {value!r:.80}; give a whole number of 0 or more")
    return result


def _count_samples(view: View) -> int:
    """Returns the approximate number of samples of a picture. The choice of the kernels depends on it."""
    whole = settle_quality(view)
    crop = whole.crop
    if crop is not None and len(crop) == 4:
        size = (crop[2] - crop[0], crop[3] - crop[1])
    else:
        size = _promin.choose_size(to_dict(Camera()), size_of(whole)) or (1, 1)
    samples = (whole.min_spp if has_target(whole) else whole.spp) or 1
    return max(0, size[0] * size[1] * samples)


@names_keywords
def render(
    scene: SceneLike,
    device: DeviceLike = None,
    *,
    aovs: Iterable[str] = (),
    light: str = "auto",
    background: Background = None,
    environment: str | os.PathLike[str] | None = None,
    environment_rotation: float | None = None,
    environment_intensity: float | None = None,
    light_rotation: float | None = None,
    ground: bool | None = None,
    exposure: float | str = "auto",
    builder: str = "sah",
    instances: str = "auto",
    progress: Progress = None,
    camera: CameraLike = None,
    size: Size = None,
    crop: tuple[int, int, int, int] | None = None,
    spp: int | None = None,
    quality: str | None = None,
    max_depth: int | None = None,
    seed: int | None = None,
    target_error: float | None = None,
    time_limit: float | str | None = None,
    min_spp: int | None = None,
    max_spp: int | None = None,
    error_in: str | None = None,
    filter: str | None = None,
    filter_width: float | None = None,
    depth: str | None = None,
    debug_view: str | None = None,
    occlusion_distance: float | None = None,
    shadows: bool | None = None,
    integrator: str | None = None,
    from_: str | None = None,
    fit: float | None = None,
    azimuth: float | None = None,
    elevation: float | None = None,
    roll: float | None = None,
    zoom: float | None = None,
    eye: Numbers | None = None,
    look_at: Numbers | None = None,
    direction: Numbers | None = None,
    up: Numbers | str | None = None,
    fov: float | None = None,
    near: float | None = None,
) -> Frame:
    """Renders one picture of a scene or a scene file. Example: promin.render("model.glb", size="hd").save("model.png").
    The defaults and keywords are those of `promin render`. For several pictures of one scene, a Renderer is faster. Its
    __init__ and `render` describe the keywords and the exceptions."""
    view = change_view(View(), locals())
    renderer = Renderer(
        scene,
        device,
        aovs=aovs,
        view=view,
        light=light,
        background=background,
        environment=environment,
        environment_rotation=environment_rotation,
        environment_intensity=environment_intensity,
        light_rotation=light_rotation,
        ground=ground,
        exposure=exposure,
        builder=builder,
        instances=instances,
        expected_samples=_count_samples(view),
        progress=progress,
    )
    return renderer.render(progress=progress)
