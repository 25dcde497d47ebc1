# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Scenes that are made from a file, from arrays and shapes, or from a file with additions."""

from __future__ import annotations

import dataclasses
import hashlib
import os
import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, TypeVar, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from promin import _promin
from promin._arrays import RaysLike, check_hits, positions, round_once, split_rays, to_numbers, to_vectors
from promin._errors import InputError, UsageError
from promin._records import Camera, Environment, Light, Material, Phong, change, from_dict, suggest, to_dict

IDENTITY = np.eye(4)


class ObjectInfo(NamedTuple):
    """A description of an object."""

    name: str
    """The display name; may be empty."""
    primitive_count: int
    """Number of the object's triangles, or 1 for an analytic shape; 0 if nothing is drawn."""
    material: int
    """Index of the object's material in the scene."""


class AnimationInfo(NamedTuple):
    """A description of an animation."""

    name: str
    """The display name; may be empty."""
    duration: float
    """The time of the last key in seconds."""
    channels: dict[str, int]
    """The properties that the animation changes, such as "rotation", and for each the number of its channels."""


@dataclass(frozen=True)
class _Pose:
    """The arguments of Scene.at, with animations as names or numbers in text."""

    time: float
    animations: tuple[str, ...]
    loop: bool


@dataclass(frozen=True)
class _File:
    """A scene file, its content at the time of reading, and the pose of the scene."""

    path: str
    sha256: str
    is_strict: bool
    variant: str
    root: str
    pose: _Pose | None = None


@dataclass(frozen=True)
class _Mesh:
    name: str
    vertices: NDArray[Any]
    faces: NDArray[np.uint32]
    normals: NDArray[np.float32] | None
    colors: NDArray[np.float32] | None
    material: int
    transform: NDArray[np.float64]

    def __len__(self) -> int:
        return 1

    def corners(self) -> NDArray[np.float64]:
        """Returns the vertices in world coordinates, in float64."""
        return self.vertices @ self.transform[:3, :3].T + self.transform[:3, 3]

    def add_to(self, scene: _promin.Scene, center: NDArray[np.float64]) -> NDArray[np.float64]:
        """Adds the mesh to the library's scene. Returns the translation from the stored vertices to the caller's."""
        vertices, transform = self.vertices, self.transform
        moved = np.zeros(3)
        if transform is IDENTITY:
            vertices = vertices - center if center.any() else vertices
            moved = center
        elif vertices.dtype == np.float64 and len(vertices):
            # The vertices are stored relative to the mesh's own middle, in float32; the transform stays in double.
            middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
            vertices = vertices - middle
            moved = middle
            transform = _translation(-center) @ transform @ _translation(middle)
        else:
            transform = _translation(-center) @ transform
        scene.add_mesh(self.name, round_once(vertices), self.faces, self.normals, self.colors, self.material, transform)
        return moved


@dataclass(frozen=True)
class _Shape:
    name: str
    kind: str
    record: dict[str, Any]
    material: int
    transform: NDArray[np.float64]

    def __len__(self) -> int:
        return 1

    def add_to(self, scene: _promin.Scene, center: NDArray[np.float64]) -> NDArray[np.float64]:
        transform = _translation(-center) @ self.transform
        scene.add_shape(self.name, self.kind, self.record, self.material, np.ascontiguousarray(transform))
        return np.zeros(3)


@dataclass(frozen=True)
class _Instances:
    source: int
    transforms: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.transforms)

    def add_to(
        self, scene: _promin.Scene, center: NDArray[np.float64], moved: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Adds the instances. `moved` is the translation that the source's add_to has returned."""
        transforms = _translation(-center) @ self.transforms @ _translation(moved)
        scene.add_instances(self.source, np.ascontiguousarray(transforms))
        return moved


class Scene:
    """A scene to trace: objects, materials, lights, cameras and environment.

    Objects are numbered in the order in which they are added; objects of a file come first. A scene is a plain value:
    Caster and Renderer use its state at their construction. A pickled scene holds its arrays and the path and SHA-256
    of its file.

    Precision: devices compute in float32. A scene with float64 vertices has a `center`, which is subtracted in float64
    from vertices, shapes, lights, cameras and the origins of rays before they are rounded. Hits and pictures are
    returned in the original world coordinates. A scene from a file has the center with which it was read: 0, unless the
    file lies so far from the origin that float32 is too coarse. Scenes with float32 vertices are not moved."""

    _base: _promin.Scene | None
    _native: _promin.Scene | None
    _native_center: NDArray[np.float64]
    _native_moves: dict[int, NDArray[np.float64]]

    def __init__(self, *, center: ArrayLike | None = None) -> None:
        """Creates an empty scene. center: the point (3,) that is subtracted from coordinates before they are rounded.
        None: if some vertices are float64, it is the middle of the bounds of all vertices, rounded to eighths of the
        bounds' size or finer, so that a scene around the origin does not move; otherwise it is the origin."""
        self._file: _File | None = None
        self._parts: list[_Mesh | _Shape | _Instances] = []
        self._materials: list[Material] = []
        self._lights: list[Light] = []
        # All materials or all lights, including those of the file. Set when the caller changes one of them.
        self._all_materials: list[Material] | None = None
        self._all_lights: list[Light] | None = None
        self._cameras: list[Camera] = []
        self._environment: Environment | None = None
        self._center: NDArray[np.float64] | None = None
        if center is not None:
            self._center = to_vectors(center, "center").astype(np.float64)
            if self._center.shape != (3,) or not np.isfinite(self._center).all():
                raise UsageError("center is not a point of three finite numbers")
        self._make_private()

    @staticmethod
    def load(
        path: str | os.PathLike[str],
        *,
        strict: bool = False,
        variant: str = "",
        root: str | os.PathLike[str] | None = None,
    ) -> Scene:
        """Reads a scene file; the file name's extension determines the format: .gltf, .glb, .obj, .ply, .stl or .nff.
        strict: refuse a file that breaks any rule of its format or requires an unknown extension of glTF; otherwise all
        geometry that can be drawn is drawn, and `warnings` lists the repairs. variant: the material variant to use, one
        of `variants`. root: a folder whose files the scene may refer to, in addition to the scene's own folder;
        symbolic links are resolved first. Raises InputError with all problems of the file, and UsageError if the
        variant does not exist or root is not a folder."""
        file = Path(os.fsdecode(path))
        folder = "" if root is None else os.path.abspath(os.fsdecode(root))
        base = _promin.Scene.load(str(file), bool(strict), str(variant), folder)
        scene = Scene(center=base.center())
        scene._file = _File(os.path.abspath(file), _hash(file), bool(strict), str(variant), folder)
        scene._base = base
        return scene

    def at(
        self, time: float, animation: str | int | Sequence[str | int] | None = 0, *, loop: bool = False
    ) -> Scene:
        """Returns a copy of the scene as an animation of its file has it after `time` seconds. Objects keep their
        numbers.

        animation: the name or number of an animation, a list of them, "all", or None for the pose of the file's nodes.
        If several animations change the same property, the one that comes first in the file counts. loop: start each
        animation again after its end. Otherwise nothing moves before its first key and after its last one. Objects,
        materials and lights that the caller has added or replaced do not move.

        Raises UsageError if the animation does not exist, and InputError if it cannot be shown."""
        if self._file is None:
            raise UsageError("the scene has no file, so it has no animations; load it with Scene.load")
        pose = _Pose(_real(time), _animation_words(animation), bool(loop))
        posed = self._load_base().at(pose.time, list(pose.animations), pose.loop)
        twin = self.snapshot()
        twin._file = dataclasses.replace(self._file, pose=pose)
        twin._base = posed
        twin._native = None
        return twin

    # Methods that add to the scene.

    def add_triangles(
        self,
        vertices: ArrayLike,
        faces: ArrayLike,
        *,
        transform: ArrayLike | None = None,
        material: int | None = None,
        normals: ArrayLike | None = None,
        colors: ArrayLike | None = None,
        name: str = "",
    ) -> int:
        """Adds a mesh and returns its object number.

        vertices: (n, 3) in world units; float32 keeps its type, all others become float64. faces: (m, 3) integers from
        0 to n - 1, counterclockwise as seen from outside; hits use the faces' numbers. transform: (4, 4) for column
        vectors, affine and not singular. material: a number that add_material returned; None: a light grey. normals:
        (n, 3) for smooth shading, of any length except 0. colors: (n, 3) or (n, 4) linear factors of the material's
        colour. Raises UsageError; `validate` finds further problems."""
        points = to_vectors(vertices, "vertices")
        triangles = _to_faces(faces)
        if points.ndim != 2:
            raise UsageError(f"vertices have the shape {points.shape}; give (n, 3)")
        mesh = _Mesh(
            str(name),
            _frozen(points),
            triangles,
            None if normals is None else _per_vertex(normals, "normals", len(points), (3,)),
            None if colors is None else _with_alpha(_per_vertex(colors, "colors", len(points), (3, 4))),
            self._material_number(material),
            _to_matrix(transform),
        )
        return self._add(mesh)

    def add_sphere(self, center: ArrayLike = (0, 0, 0), radius: float = 0.5, **place: Any) -> int:
        """Adds a sphere and returns its object number. `place` stands for keywords that all shapes have:
        transform=None, material=None, name=""."""
        return self._add_shape("sphere", place, center=center, radius=radius)

    def add_plane(self, point: ArrayLike = (0, 0, 0), normal: ArrayLike = (0, 1, 0), **place: Any) -> int:
        """Adds an infinite plane through `point` and returns its object number. The normal may have any length except
        0."""
        return self._add_shape("plane", place, point=point, normal=normal)

    def add_box(self, center: ArrayLike = (0, 0, 0), half_size: ArrayLike = (0.5, 0.5, 0.5), **place: Any) -> int:
        """Adds a solid box along the coordinate axes and returns its object number. half_size: the distance of the
        faces from the middle."""
        return self._add_shape("box", place, center=center, half_size=half_size)

    def add_cylinder(
        self,
        center: ArrayLike = (0, 0, 0),
        axis: ArrayLike = (0, 1, 0),
        half_height: float = 0.25,
        radius: float = 0.25,
        *,
        is_open: bool = False,
        **place: Any,
    ) -> int:
        """Adds a cylinder and returns its object number. center: the middle of its axis. half_height: the distance of
        its disks from there. An open cylinder has no disks."""
        return self._add_shape(
            "cylinder", place, center=center, axis=axis, half_height=half_height, radius=radius, is_open=is_open
        )

    def add_cone(
        self,
        center: ArrayLike = (0, 0, 0),
        axis: ArrayLike = (0, 1, 0),
        half_height: float = 0.25,
        radius_bottom: float = 0.25,
        radius_top: float = 0.0,
        *,
        is_open: bool = False,
        **place: Any,
    ) -> int:
        """Adds a cone or frustum and returns its object number. The axis points from the bottom to the top. The other
        arguments are as in add_cylinder."""
        return self._add_shape(
            "cone",
            place,
            center=center,
            axis=axis,
            half_height=half_height,
            radius_bottom=radius_bottom,
            radius_top=radius_top,
            is_open=is_open,
        )

    def add_capsule(
        self,
        center: ArrayLike = (0, 0, 0),
        axis: ArrayLike = (0, 1, 0),
        half_height: float = 0.25,
        radius_bottom: float = 0.25,
        radius_top: float = 0.25,
        **place: Any,
    ) -> int:
        """Adds a capsule, the convex hull of two spheres, and returns its object number. half_height: the distance of
        the spheres' centres from the middle."""
        return self._add_shape(
            "capsule",
            place,
            center=center,
            axis=axis,
            half_height=half_height,
            radius_bottom=radius_bottom,
            radius_top=radius_top,
        )

    def add_instances(self, object: int, transforms: ArrayLike) -> range:
        """Adds objects that share the geometry, material and name of an object, and returns their numbers. Instances of
        a mesh need little memory (docs/instances.md).

        object: the number of an object of this scene that has a geometry. transforms: (n, 4, 4) for column vectors,
        from the object's own space to the world, affine and not singular. They replace the object's own transform. The
        space of an object of a file is that of the file's mesh. Raises UsageError."""
        matrices: NDArray[np.float64] = _frozen(np.array(to_numbers(transforms, "transforms"), np.float64))
        if matrices.ndim != 3 or matrices.shape[1:] != (4, 4):
            raise UsageError(f"transforms have the shape {matrices.shape}; give (n, 4, 4)")
        if isinstance(object, bool) or not isinstance(object, (int, np.integer)) or not 0 <= object < self._count():
            raise UsageError(f"object is {object!r:.80}; give the number of an object of this scene")
        first = self._count()
        if len(matrices):
            self._add(_Instances(int(object), matrices))
        return range(first, first + len(matrices))

    def add_material(self, material: Material) -> int:
        """Adds a material and returns its number. The materials of a file come first."""
        materials = self._materials if self._all_materials is None else self._all_materials
        materials.append(_of(material, Material))
        self._forget_native()
        return self._material_count() - 1

    def add_light(self, light: Light) -> int:
        """Adds a light and returns its number. If a scene has neither lights nor a sky, `Renderer(light=...)` adds
        light."""
        lights = self._lights if self._all_lights is None else self._all_lights
        lights.append(_of(light, Light))
        self._forget_native()
        return len(self.lights) - 1

    def add_camera(self, camera: Camera) -> int:
        """Adds a camera and returns its number. The first camera is the default."""
        self._cameras.append(_of(camera, Camera))
        self._forget_native()
        return len(self.cameras) - 1

    # Methods that change the scene.

    def set_material(self, material: str | int, new: Material | None = None, **fields: Any) -> None:
        """Changes a material by its name or number: `new` replaces it, or `fields` get other values. Example:
        scene.set_material("Fabric", base_color=(1, 0, 0), base_color_texture=None). A texture multiplies the colour or
        number; None removes the texture. Raises UsageError if there is no such material or field, if several materials
        have the name, and for a value of the wrong type; the scene then stays unchanged. `validate` checks ranges."""
        other = None if new is None else _of(new, Material)
        self.materials = replace_one(self.materials, material, other, fields, "material")

    def set_light(self, light: str | int, new: Light | None = None, **fields: Any) -> None:
        """Changes a light in the same way as set_material changes a material. Example: scene.set_light(0,
        is_on=False)."""
        other = None if new is None else _of(new, Light)
        self.lights = replace_one(self.lights, light, other, fields, "light")

    # Properties of the scene.

    @property
    def path(self) -> Path | None:
        """The file from which the scene was read."""
        return None if self._file is None else Path(self._file.path)

    @property
    def center(self) -> NDArray[np.float64]:
        """The point (3,) float64 that is subtracted from coordinates before they are rounded to float32."""
        if self._center is not None:
            return self._center.copy()
        meshes = [part for part in self._parts if isinstance(part, _Mesh) and len(part.vertices)]
        if not any(mesh.vertices.dtype == np.float64 for mesh in meshes):
            return np.zeros(3)
        corners = [mesh.corners() for mesh in meshes]
        low = np.stack([c.min(axis=0) for c in corners]).min(axis=0)
        high = np.stack([c.max(axis=0) for c in corners]).max(axis=0)
        return _middle(low, high)

    @property
    def objects(self) -> list[ObjectInfo]:
        """The scene's objects, indexed by the object numbers of hits. In a scene from an NFF file each surface is an
        object."""
        return [ObjectInfo(*row) for row in self.native().objects()]

    @property
    def materials(self) -> list[Material]:
        """Copies of the scene's materials. An assignment replaces all materials; set_material changes one."""
        return [from_dict(Material, record) for record in self.native().materials()]

    @materials.setter
    def materials(self, materials: Iterable[Material]) -> None:
        self._all_materials = [_of(material, Material) for material in materials]
        self._forget_native()

    @property
    def lights(self) -> list[Light]:
        """Copies of the scene's lights, without the lights that a Renderer adds. An assignment replaces all lights;
        set_light changes one."""
        if self._all_lights is not None:
            return list(self._all_lights)
        base = [] if self._file is None else [from_dict(Light, record) for record in self._load_base().lights()]
        return [to_world(light, self.center) for light in base] + list(self._lights)

    @lights.setter
    def lights(self, lights: Iterable[Light]) -> None:
        self._all_lights = [_of(light, Light) for light in lights]
        self._forget_native()

    @property
    def cameras(self) -> list[Camera]:
        """Copies of the scene's cameras. If the list is empty, a Renderer frames the scene."""
        base = [] if self._file is None else [from_dict(Camera, record) for record in self._load_base().cameras()]
        return [to_world(camera, self.center) for camera in base] + list(self._cameras)

    @property
    def environment(self) -> Environment:
        """Ambient light, background and sky. An assignment replaces the environment."""
        if self._environment is not None:
            return self._environment
        return Environment() if self._file is None else from_dict(Environment, self._load_base().environment())

    @environment.setter
    def environment(self, environment: Environment) -> None:
        self._environment = _of(environment, Environment)
        self._forget_native()

    @property
    def bounds(self) -> NDArray[np.float64] | None:
        """The bounds of all finite geometry, (2, 3): the smallest and the largest corner of the rounded coordinates.
        None if there is no finite geometry."""
        box = self.native().bounds()
        return None if box is None else np.array(box, np.float64) + self._native_center

    @property
    def warnings(self) -> list[str]:
        """Features of the scene's file that promin does not model, and assumptions that it made. Each is one
        sentence."""
        return list(self.native().warnings())

    @property
    def variants(self) -> list[str]:
        """Material variants of the scene's file."""
        return list(self.native().variants())

    @property
    def animations(self) -> list[AnimationInfo]:
        """The animations of the scene's file, which `at` shows."""
        return [AnimationInfo(*row) for row in self.native().animations()]

    def validate(self) -> None:
        """Raises InputError with all problems of the scene and their places; does nothing if there are none. Caster and
        Renderer check the scene in the same way."""
        self.native().validate()

    def positions(self, rays: RaysLike, hits: NDArray[Any]) -> NDArray[np.float64]:
        """Returns the hit points, (..., 3) float64, NaN on a miss. On a mesh that `add_triangles` added, a point is the
        intersection of the ray with the plane of the triangle, computed in float64 from the caller's vertices. On other
        objects it is the result of `promin.positions`."""
        points = positions(rays, hits)
        hits = check_hits(hits)
        origins, _, directions, _ = split_rays(rays)
        origins = np.broadcast_to(origins, points.shape)
        directions = np.broadcast_to(directions, points.shape)
        meshes: dict[int, _Mesh] = {}
        number = self._base_count()
        for part in self._parts:
            if isinstance(part, _Mesh):
                meshes[number] = part
                chosen = hits["object"] == number
                triangles = part.corners()[part.faces[hits["primitive"][chosen]]]
                points[chosen] = meet_planes(origins[chosen], directions[chosen], triangles, points[chosen])
            elif isinstance(part, _Instances) and part.source in meshes:
                mesh = meshes[part.source]
                meshes.update((number + i, mesh) for i in range(len(part)))
                chosen = (hits["object"] >= number) & (hits["object"] < number + len(part))
                transforms = part.transforms[hits["object"][chosen] - number]
                corners = np.asarray(mesh.vertices[mesh.faces[hits["primitive"][chosen]]], np.float64)
                triangles = corners @ transforms[:, :3, :3].transpose(0, 2, 1) + transforms[:, None, :3, 3]
                points[chosen] = meet_planes(origins[chosen], directions[chosen], triangles, points[chosen])
            number += len(part)
        return points

    def __repr__(self) -> str:
        name = "" if self._file is None else f" {Path(self._file.path).name}"
        objects = self.objects
        primitives = sum(each.primitive_count for each in objects)
        counts = [(len(objects), "object"), (primitives, "primitive"), (len(self.materials), "material")]
        counts += [(len(self.lights), "light"), (len(self.cameras), "camera")]
        words = [f"{number} {word}{'s' * (number != 1)}" for number, word in counts]
        return f"<promin.Scene{name}: {', '.join(words)}>"

    # Native parts, which are created at their first use.

    def native(self) -> _promin.Scene:
        """Returns the library's read-only scene, from which the center is subtracted. Only promin's own modules use
        it."""
        with self._lock:
            if self._native is None:
                center = self.center
                self._native = self._make_native(center)
                self._native_center = center
            return self._native

    def snapshot(self) -> Scene:
        """Returns a copy of the scene. Later changes of this scene do not change the copy, which shares its arrays and
        the data derived from them."""
        twin = object.__new__(type(self))
        with self._lock:
            self.native()
            # copy.copy would pickle the scene and therefore read the file again.
            twin.__dict__.update(self.__dict__)
        twin._lock = threading.RLock()
        twin._parts, twin._materials = list(self._parts), list(self._materials)
        twin._lights, twin._cameras = list(self._lights), list(self._cameras)
        twin._all_materials = None if self._all_materials is None else list(self._all_materials)
        twin._all_lights = None if self._all_lights is None else list(self._all_lights)
        return twin

    @property
    def native_center(self) -> NDArray[np.float64]:
        """The center that was subtracted from the coordinates of `native`."""
        self.native()
        return self._native_center

    def native_transforms(self, transforms: Mapping[int, ArrayLike]) -> dict[int, NDArray[np.float64]]:
        """Returns transforms for `native`: from an object's vertices as it stores them to its coordinates. transforms:
        (4, 4) by the number of the object, from the object's own space to the world. Raises UsageError."""
        count = self.native().object_count()
        found: dict[int, NDArray[np.float64]] = {}
        for number, transform in transforms.items():
            if isinstance(number, bool) or not isinstance(number, (int, np.integer)) or not 0 <= number < count:
                raise UsageError(f"transforms has the object {number!r:.80}; give numbers below {count}")
            matrix = _to_matrix(transform)
            if self._native_center.any() or int(number) in self._native_moves:
                moved = self._native_moves.get(int(number), np.zeros(3))
                matrix = _translation(-self._native_center) @ matrix @ _translation(moved)
            found[int(number)] = matrix
        return found

    def _make_native(self, center: NDArray[np.float64]) -> _promin.Scene:
        self._native_moves = {}
        if self._file is not None and not self._has_additions():
            return self._load_base()
        scene = _promin.Scene() if self._file is None else self._load_base().copy()
        scene.set_center(*center.tolist())
        if self._all_materials is not None:
            scene.set_materials([to_dict(material) for material in self._all_materials])
        elif self._materials:
            for material in self._materials:
                scene.add_material(to_dict(material))
        elif self._parts and self._material_count() == 0:
            scene.add_material(to_dict(Phong()))
        moves = self._native_moves
        number = self._base_count()
        for part in self._parts:
            if isinstance(part, _Instances):
                moved = part.add_to(scene, center, moves.get(part.source, np.zeros(3)))
            else:
                moved = part.add_to(scene, center)
            if moved.any():
                moves.update((number + i, moved) for i in range(len(part)))
            number += len(part)
        if self._all_lights is not None:
            scene.set_lights([move_light(light, center) for light in self._all_lights])
        else:
            for light in self._lights:
                scene.add_light(move_light(light, center))
        for camera in self._cameras:
            scene.add_camera(move_camera(camera, center))
        if self._environment is not None:
            scene.set_environment(to_dict(self._environment))
        return scene

    def _has_additions(self) -> bool:
        added = (self._parts, self._materials, self._lights, self._cameras)
        replaced = (self._all_materials, self._all_lights, self._environment)
        return any(added) or any(value is not None for value in replaced)

    def _load_base(self) -> _promin.Scene:
        assert self._file is not None
        with self._lock:
            if self._base is None:
                file = Path(self._file.path)
                if _hash(file) != self._file.sha256:
                    raise InputError(f"{file}: the file has changed since the scene was pickled; load it again")
                base = _promin.Scene.load(str(file), self._file.is_strict, self._file.variant, self._file.root)
                if self._file.pose is not None:
                    pose = self._file.pose
                    base = base.at(pose.time, list(pose.animations), pose.loop)
                self._base = base
            return self._base

    def _material_count(self) -> int:
        if self._all_materials is not None:
            return len(self._all_materials)
        return len(self._materials) + (0 if self._file is None else len(self._load_base().materials()))

    def _base_count(self) -> int:
        """Returns the number of objects of the file."""
        return 0 if self._file is None else self._load_base().object_count()

    def _count(self) -> int:
        return self._base_count() + sum(len(part) for part in self._parts)

    def _add(self, part: _Mesh | _Shape | _Instances) -> int:
        """Returns the number of the part's first object."""
        number = self._count()
        self._parts.append(part)
        self._forget_native()
        return number

    def _add_shape(self, kind: str, place: dict[str, Any], **fields: Any) -> int:
        record = {name: _FIELDS.get(name, _real)(value) for name, value in fields.items()}
        transform, material, name = (place.pop(key, None) for key in ("transform", "material", "name"))
        if place:
            raise TypeError(f"add_{kind}() got an unexpected keyword argument '{next(iter(place))}'")
        return self._add(_Shape(str(name or ""), kind, record, self._material_number(material), _to_matrix(transform)))

    def _material_number(self, material: object) -> int:
        if material is None:
            return 0
        if not isinstance(material, (int, np.integer)) or not 0 <= material < 2**32:
            raise UsageError(f"material is {material!r}; give a number from add_material")
        return int(material)

    def _make_private(self) -> None:
        """Creates the members that are not pickled: the library's scene of the file, and the library's whole scene.
        Both are made at their first use."""
        self._lock = threading.RLock()
        self._base = None
        self._native = None
        self._native_center = np.zeros(3)
        # The translation from the stored vertices of an object to the caller's, if it is not 0.
        self._native_moves = {}

    def _forget_native(self) -> None:
        self._native = None

    def __getstate__(self) -> dict[str, Any]:
        private = ("_base", "_lock", "_native", "_native_center", "_native_moves")
        return {key: value for key, value in self.__dict__.items() if key not in private}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._make_private()


SceneLike = Union[Scene, str, "os.PathLike[str]"]
"""A scene or the path of its file."""

Named = TypeVar("Named", Material, Light)


def to_scene(scene: SceneLike) -> Scene:
    """Returns the argument if it is a scene, or the scene of a file. Raises UsageError and the exceptions of
    Scene.load."""
    if isinstance(scene, Scene):
        return scene
    if isinstance(scene, (str, os.PathLike)):
        return Scene.load(scene)
    raise UsageError(f"{scene!r:.80} is not a promin.Scene; load or make one first")


REMAKES = ("scene.move.copied", "scene.move.sheared")
"""The codes of moves that need a new tree."""


def split_transforms(transforms: Mapping[int, NDArray[np.float64]]) -> tuple[list[int], NDArray[np.float64]]:
    """Returns the numbers and the matrices (n, 4, 4) of Scene.native_transforms for the native module."""
    matrices = np.array(list(transforms.values()), np.float64).reshape(-1, 4, 4)
    return list(transforms), matrices


def replace_one(
    records: list[Named], chosen: str | int, new: Named | None, fields: dict[str, Any], what: str
) -> list[Named]:
    """Returns materials or lights with one of them replaced: the one with this name or number becomes `new`, with these
    fields."""
    place = _find_one(records, chosen, what)
    records[place] = change(records[place] if new is None else new, fields)
    return records


def _animation_words(animation: object) -> tuple[str, ...]:
    """Returns names and numbers of animations as text."""
    if animation is None:
        return ("none",)
    listed = list(animation) if isinstance(animation, (list, tuple)) else [animation]
    for each in listed:
        if isinstance(each, bool) or not isinstance(each, (str, int, np.integer)):
            raise UsageError(f"animation is {each!r:.80}; give the name or number of an animation")
    return tuple(str(each) for each in listed)


def _find_one(records: list[Named], chosen: str | int, what: str) -> int:
    if isinstance(chosen, (int, np.integer)) and 0 <= chosen < len(records):
        return int(chosen)
    places = [i for i, record in enumerate(records) if record.name == chosen]
    if len(places) == 1:
        return places[0]
    if places:
        raise UsageError(f"{len(places)} {what}s are named {chosen!r}; give the number of one: {places}")
    names = [record.name for record in records if record.name]
    cure = suggest(str(chosen), names) if names else f"give a number below {len(records)}"
    raise UsageError(f"no {what} {chosen!r:.80}; {cure if records else 'the scene has none'}")


def meet_planes(
    origins: NDArray[Any], directions: NDArray[Any], triangles: NDArray[Any], otherwise: NDArray[Any]
) -> NDArray[np.float64]:
    """Returns the points where rays (n, 3) intersect the planes of triangles (n, 3, 3), in float64. For a ray parallel
    to its plane it returns the point of `otherwise`."""
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        t = np.einsum("ij,ij->i", normals, triangles[:, 0] - origins) / np.einsum("ij,ij->i", normals, directions)
        points = origins + t[:, None] * directions
    return np.where(np.isfinite(points), points, otherwise)


def move_light(light: Light, center: NDArray[np.float64]) -> dict[str, Any]:
    """Returns the light's record with the center subtracted."""
    record = to_dict(light)
    record["position"] = _without(record["position"], center)
    return record


def move_camera(camera: Camera, center: NDArray[np.float64]) -> dict[str, Any]:
    """Returns the camera's record with the center subtracted."""
    record = to_dict(camera)
    record["eye"] = _without(record["eye"], center)
    return record


def to_world(record: Any, center: NDArray[np.float64]) -> Any:
    """Returns a camera or light in world coordinates. The argument is a record of a native scene with this center."""
    if not center.any():
        return record
    name = "eye" if isinstance(record, Camera) else "position"
    moved = tuple(float(x) for x in np.asarray(getattr(record, name)) + center)
    return dataclasses.replace(record, **{name: moved})


def _without(point: Any, center: NDArray[np.float64]) -> Any:
    if not center.any():
        return point
    try:
        return tuple(float(x) for x in np.asarray(point, np.float64) - center)
    except (TypeError, ValueError):
        # The native module reports the problem.
        return point


def _middle(low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns a point near the middle of the bounds whose coordinates have few bits, so that small whole numbers stay
    exact after the point is subtracted."""
    with np.errstate(over="ignore", invalid="ignore"):
        middle = low / 2 + high / 2
        size = float(np.max(high - low))
    if not np.isfinite(middle).all() or not np.isfinite(size):
        # The native module refuses numbers that are not finite and reports where they are.
        return np.zeros(3)
    if size == 0.0:
        return middle
    step = 2.0 ** np.floor(np.log2(size) - 2)
    return np.asarray(np.round(middle / step) * step) + 0.0


def _hash(file: Path) -> str:
    digest = hashlib.sha256()
    try:
        with open(file, "rb") as stream:
            while block := stream.read(1 << 20):
                digest.update(block)
    except OSError as error:
        raise InputError(f"{file}: the scene cannot be read ({error.strerror}); check the path and its permissions") from None
    return digest.hexdigest()


def _frozen(array: NDArray[Any]) -> NDArray[Any]:
    """Returns a read-only copy of the array."""
    own = np.array(array, order="C")
    own.setflags(write=False)
    return own


def _to_faces(faces: ArrayLike) -> NDArray[np.uint32]:
    array = to_vectors(faces, "faces")
    if array.ndim != 2:
        raise UsageError(f"faces have the shape {array.shape}; give (m, 3)")
    with np.errstate(invalid="ignore"):
        if not ((array >= 0) & (array < 2**32) & (array == np.floor(array))).all():
            raise UsageError("faces are not indices of vertices; give whole numbers of 0 or more")
    own: NDArray[np.uint32] = _frozen(array.astype(np.uint32))
    return own


def _per_vertex(values: ArrayLike, what: str, count: int, widths: Iterable[int]) -> NDArray[np.float32]:
    array = to_numbers(values, what)
    if array.ndim != 2 or len(array) != count or array.shape[1] not in widths:
        raise UsageError(f"{what} have the shape {array.shape}; give one for each of {count} vertices")
    own: NDArray[np.float32] = _frozen(round_once(array))
    return own


def _with_alpha(colors: NDArray[np.float32]) -> NDArray[np.float32]:
    if colors.shape[1] == 4:
        return colors
    return np.ascontiguousarray(np.concatenate([colors, np.ones((len(colors), 1), np.float32)], axis=1))


def _to_matrix(transform: object) -> NDArray[np.float64]:
    if transform is None:
        return IDENTITY
    array = to_numbers(transform, "transform")
    if array.shape != (4, 4):
        raise UsageError(f"transform has the shape {array.shape}; give (4, 4)")
    own: NDArray[np.float64] = _frozen(array.astype(np.float64))
    return own


def _translation(offset: NDArray[np.float64]) -> NDArray[np.float64]:
    matrix = np.eye(4)
    matrix[:3, 3] = offset
    return matrix


def _vec(value: ArrayLike) -> tuple[float, ...]:
    array = to_vectors(value, "the numbers")
    if array.shape != (3,):
        raise UsageError(f"three numbers are needed, not an array of the shape {array.shape}")
    return tuple(float(x) for x in array)


def _real(value: object) -> float:
    array = to_numbers(value, "the number")
    if array.shape != ():
        raise UsageError(f"one number is needed, not an array of the shape {array.shape}")
    return float(array)


_FIELDS: dict[str, Callable[[Any], Any]] = {
    "center": _vec,
    "axis": _vec,
    "point": _vec,
    "normal": _vec,
    "half_size": _vec,
    "is_open": bool,
}
"""Converters for fields of shapes; all other fields are numbers."""


_READERS: dict[type[Any], Callable[[_promin.Scene, dict[str, Any]], None]] = {
    Camera: _promin.Scene.add_camera,
    Environment: _promin.Scene.set_environment,
    Light: _promin.Scene.add_light,
    Material: _promin.Scene.add_material,
}
"""Functions of the native module that read a record, by the class of the record."""


def _of(record: Any, kind: type[Any]) -> Any:
    """Returns the record. Raises UsageError if the record has another type, or if the native module cannot read one of
    its fields. A scene with such a record could neither be used nor corrected."""
    if not isinstance(record, kind):
        raise UsageError(f"{record!r:.80} is not a promin.{kind.__name__}")
    _READERS[kind](_promin.Scene(), to_dict(record))
    return record
