#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Compares the speed and the noise of promin's sampled light with Mitsuba 3 and Cycles, in one run on one machine.

The scene is a glTF file of meshes with diffuse materials (factors only) and one camera. The peers render its emissive
meshes; a second file may have the same scene with an area light for promin. All programs render the same picture. The
errors are those of the pixels that are not next to an emissive surface, compared with a picture of Mitsuba with many
samples, without the noise of that picture. The times are CPU times of tracing on all cores, so other programs disturb
them little: the difference of a run and of a short run, which contains loading and compiling. They are medians of
several runs that alternate.

Needs `pip install mitsuba numpy`. Mitsuba's LLVM variant needs LLVM 16 or later (DRJIT_LIBLLVM_PATH). Cycles takes part
where `bpy` is installed (`pip install bpy`, tried with 5.0.1).
"""

import argparse
import contextlib
import json
import math
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

import mitsuba as mi
import numpy as np

try:
    import bpy
    import mathutils
except ImportError:
    bpy = None

_FORMATS = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
_COLUMNS = {"SCALAR": 1, "VEC3": 3}


class Model:
    """Reads the parts of a glTF file that this comparison uses."""

    def __init__(self, path):
        self.json = json.loads(path.read_text())
        self.buffers = [(path.parent / each["uri"]).read_bytes() for each in self.json["buffers"]]

    def array(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        columns = _COLUMNS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        values = np.frombuffer(
            self.buffers[view["buffer"]], _FORMATS[accessor["componentType"]], accessor["count"] * columns, start
        )
        return values.reshape(-1, columns)

    def radiance_of(self, material):
        strength = (
            material.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1.0)
        )
        return [strength * factor for factor in material.get("emissiveFactor", [0.0, 0.0, 0.0])]

    def meshes(self):
        """Yields positions, triangles, colour and emitted radiance of each mesh in the world."""
        for node in self.json["nodes"]:
            if "mesh" not in node:
                continue
            shift = np.array(node.get("translation", [0, 0, 0]), np.float32)
            for primitive in self.json["meshes"][node["mesh"]]["primitives"]:
                material = self.json["materials"][primitive["material"]]
                color = material["pbrMetallicRoughness"]["baseColorFactor"][:3]
                positions = self.array(primitive["attributes"]["POSITION"]) + shift
                yield positions, self.array(primitive["indices"]).reshape(-1, 3), color, self.radiance_of(material)

    def camera(self):
        """Returns the camera's matrix and its vertical field of view in degrees."""
        node = next(each for each in self.json["nodes"] if "camera" in each)
        lens = self.json["cameras"][node["camera"]]["perspective"]
        return np.array(node["matrix"]).reshape(4, 4).T, math.degrees(lens["yfov"])


def rgb(values):
    return {"type": "rgb", "value": list(values)}


def scene_of_mitsuba(model, size, depth, sampler, samples):
    matrix, field = model.camera()
    eye = matrix[:3, 3]
    film = {"type": "hdrfilm", "width": size, "height": size, "pixel_format": "rgb", "rfilter": {"type": "box"}}
    sensor = {
        "type": "perspective",
        "fov": field,
        "fov_axis": "y",
        "to_world": mi.ScalarTransform4f().look_at(
            origin=eye.tolist(), target=(eye - matrix[:3, 2]).tolist(), up=matrix[:3, 1].tolist()
        ),
        "film": film,
        "sampler": {"type": sampler, "sample_count": samples},
    }
    scene = {"type": "scene", "integrator": {"type": "path", "max_depth": depth, "rr_depth": 1000}, "sensor": sensor}
    for number, (positions, triangles, color, radiance) in enumerate(model.meshes()):
        properties = mi.Properties()
        diffuse = {"type": "diffuse", "reflectance": rgb(color)}
        properties["bsdf"] = mi.load_dict({"type": "twosided", "inner": diffuse})
        if any(radiance):
            properties["emitter"] = mi.load_dict({"type": "area", "radiance": rgb(radiance)})
        mesh = mi.Mesh(f"mesh{number}", len(positions), len(triangles), props=properties)
        parameters = mi.traverse(mesh)
        parameters["vertex_positions"] = np.ascontiguousarray(positions, np.float32).ravel()
        parameters["faces"] = np.ascontiguousarray(triangles, np.uint32).ravel()
        parameters.update()
        scene[f"mesh{number}"] = mesh
    return mi.load_dict(scene)


class Mitsuba:
    def __init__(self, arguments, sampler):
        self.arguments = arguments
        self.model = Model(arguments.scene)
        self.name = f"Mitsuba, {sampler}"
        self.sampler = sampler

    def render(self, samples, seed=0, depth=None):
        """Returns the picture and the seconds of tracing. The first rendering compiles the kernel."""
        depth = self.arguments.depth if depth is None else depth
        scene = scene_of_mitsuba(self.model, self.arguments.size, depth, self.sampler, samples)
        np.array(mi.render(scene, spp=samples, seed=seed + 1))
        begin = time.process_time()
        picture = np.array(mi.render(scene, spp=samples, seed=seed))
        return picture, time.process_time() - begin

    def reference(self, samples):
        parts = [self.render(256, seed=2 + part)[0] for part in range(max(samples // 256, 1))]
        return sum(parts) / len(parts)


class Cycles:
    """Blender's renderer, where `bpy` is installed."""

    name = "Cycles"

    def __init__(self, arguments, folder):
        self.arguments = arguments
        self.file = folder / "cycles.exr"
        model = Model(arguments.scene)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = bpy.context.scene
        scene.world = None
        for positions, triangles, color, radiance in model.meshes():
            mesh = bpy.data.meshes.new("mesh")
            mesh.from_pydata(positions.tolist(), [], triangles.tolist())
            mesh.materials.append(material_of_cycles(color, radiance))
            scene.collection.objects.link(bpy.data.objects.new("object", mesh))
        matrix, field = model.camera()
        lens = bpy.data.cameras.new("camera")
        lens.sensor_fit, lens.lens_unit, lens.angle = "VERTICAL", "FOV", math.radians(field)
        scene.camera = bpy.data.objects.new("camera", lens)
        scene.collection.objects.link(scene.camera)
        scene.camera.matrix_world = mathutils.Matrix(matrix.tolist())
        render, cycles = scene.render, scene.cycles
        render.engine = "CYCLES"
        render.resolution_x = render.resolution_y = arguments.size
        render.threads_mode, render.threads = "FIXED", len(os.sched_getaffinity(0))
        render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
        render.filepath = str(self.file)
        scene.view_settings.view_transform = "Raw"
        # The same pixels and paths as the others: no denoiser, no samples left out, no clamps, a box as the filter.
        cycles.use_adaptive_sampling = cycles.use_denoising = False
        cycles.light_sampling_threshold = cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
        cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
        cycles.max_bounces = cycles.diffuse_bounces = max(arguments.depth - 2, 0)
        cycles.min_light_bounces = cycles.max_bounces

    def run(self, samples, seed):
        bpy.context.scene.cycles.samples = samples
        bpy.context.scene.cycles.seed = seed
        begin = time.process_time()
        with without_output():
            bpy.ops.render.render(write_still=True)
        return time.process_time() - begin

    def render(self, samples, seed=0):
        """Returns the picture and the seconds of tracing: those of a long run less those of a short run."""
        seconds = self.run(samples + 1, seed) - self.run(1, seed)
        self.run(samples, seed)
        return read_exr(self.file), seconds


def material_of_cycles(color, radiance):
    """Returns Lambert's material, which emits from the front alone, as in glTF."""
    material = bpy.data.materials.new("material")
    material.cycles.emission_sampling = "FRONT" if any(radiance) else "NONE"
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    diffuse.inputs["Color"].default_value = [*color, 1.0]
    links.new(diffuse.outputs[0], output.inputs["Surface"])
    if any(radiance):
        emission, sides, front = (nodes.new(f"ShaderNode{name}") for name in ("Emission", "NewGeometry", "Math"))
        front.operation = "SUBTRACT"
        front.inputs[0].default_value = 1.0
        strength = max(radiance)
        emission.inputs["Color"].default_value = [*(value / strength for value in radiance), 1.0]
        scaled, total = nodes.new("ShaderNodeMath"), nodes.new("ShaderNodeAddShader")
        scaled.operation = "MULTIPLY"
        scaled.inputs[1].default_value = strength
        links.new(sides.outputs["Backfacing"], front.inputs[1])
        links.new(front.outputs[0], scaled.inputs[0])
        links.new(scaled.outputs[0], emission.inputs["Strength"])
        links.new(diffuse.outputs[0], total.inputs[0])
        links.new(emission.outputs[0], total.inputs[1])
        links.new(total.outputs[0], output.inputs["Surface"])
    return material


@contextlib.contextmanager
def without_output():
    """Blender prints progress from C, past sys.stdout."""
    sys.stdout.flush()
    kept = os.dup(1)
    with open(os.devnull, "w") as nowhere:
        os.dup2(nowhere.fileno(), 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)


class Promin:
    name = "promin"

    def __init__(self, arguments, folder):
        self.arguments = arguments
        self.folder = folder

    def run(self, samples, seed):
        """Writes the picture, and returns the CPU time of the process."""
        size = self.arguments.size
        # Mitsuba counts the edge to the light too: a depth of 2 is direct light.
        depth = max(self.arguments.depth - 2, 0)
        words = [self.arguments.promin, "render", self.arguments.promin_scene or self.arguments.scene]
        integrator = "direct" if depth == 0 else "path"
        words += ["--size", f"{size}x{size}", "--spp", samples, "--seed", seed, "--integrator", integrator]
        words += ["--max-depth", depth, "--light", "none", "--background", "0", "0", "0", "--quiet"]
        words += ["-o", self.folder / "picture.exr"]
        before = cpu_of_children()
        subprocess.run([str(word) for word in words], check=True)
        return cpu_of_children() - before

    def render(self, samples, seed=0):
        """Returns the picture and the seconds of tracing: those of a long run less those of a short run."""
        # A picture with fewer samples has other kernels (samples_that_repay_packets in engine/device/profile.cpp).
        short = math.ceil(2**19 / self.arguments.size**2)
        seconds = self.run(short + samples, seed) - self.run(short, seed)
        self.run(samples, seed)
        return read_exr(self.folder / "picture.exr"), seconds


def cpu_of_children():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def read_exr(path):
    bitmap = mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
    return np.array(bitmap)


def samples_for(target, errors):
    """Returns the number of samples with this error, interpolated between powers of two on logarithmic scales, or
    extrapolated from the two nearest ones."""
    points = sorted(errors.items())
    (a, error_a), (b, error_b) = points[:2] if target > points[0][1] else points[-2:]
    for first, second in zip(points, points[1:]):
        if first[1] >= target >= second[1]:
            (a, error_a), (b, error_b) = first, second
    slope = (math.log(error_b) - math.log(error_a)) / (math.log(b) - math.log(a))
    return math.exp(math.log(a) + (math.log(target) - math.log(error_a)) / slope)


def plot(path, title, points):
    """Draws the RMSE of each renderer over the CPU time. points: (seconds, RMSE) of several pictures by name."""
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(5.5, 3.5))
    for (name, measured), marker in zip(points.items(), "os^v"):
        axes.loglog(*zip(*sorted(measured)), marker=marker, label=name)
    axes.set(xlabel="CPU seconds of tracing", ylabel="RMSE of lit surfaces", title=title)
    axes.grid(True, which="both", alpha=0.3)
    axes.legend()
    figure.tight_layout()
    figure.savefig(path, metadata={"Date": None} if path.suffix == ".svg" else None)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", type=pathlib.Path, help="glTF file with emissive meshes")
    parser.add_argument("--promin-scene", type=pathlib.Path, help="the same scene for promin [SCENE]")
    parser.add_argument("--promin", default="build/release/bin/promin", help="the program [build/release/bin/promin]")
    parser.add_argument("--depth", type=int, default=5, help="largest number of edges of a path, as Mitsuba counts [5]")
    parser.add_argument("--size", type=int, default=256, help="side of the picture in pixels [256]")
    parser.add_argument("--samples", type=int, default=64, help="samples of Mitsuba's pictures [64]")
    parser.add_argument("--reference", type=int, default=2048, help="samples of the reference [2048]")
    parser.add_argument("--runs", type=int, default=3, help="runs for each time [3]")
    parser.add_argument("--plot", type=pathlib.Path, help="SVG or PNG file for a plot of the error over time")
    arguments = parser.parse_args()
    mi.set_variant("llvm_ad_rgb")
    with tempfile.TemporaryDirectory() as folder:
        promin = Promin(arguments, pathlib.Path(folder))
        peers = [Mitsuba(arguments, sampler) for sampler in ("independent", "multijitter")]
        if bpy:
            peers.append(Cycles(arguments, pathlib.Path(folder)))
        truth = peers[0].reference(arguments.reference)
        # Without bounces, only emissive surfaces are visible.
        lamps = np.pad(peers[0].render(16, depth=1)[0].max(axis=2) > 0, 1)
        rows, columns = truth.shape[:2]
        is_lamp = np.any([lamps[y : y + rows, x : x + columns] for y in range(3) for x in range(3)], axis=0)
        surfaces = ~is_lamp & (truth.max(axis=2) > 0)

        def square_of(picture):
            return float(np.mean((picture - truth)[surfaces] ** 2))

        # The reference has noise too: that of independent samples, which decreases with their number.
        of_reference = square_of(peers[0].render(arguments.samples)[0]) / (1 + arguments.reference / arguments.samples)

        def error_of(picture):
            return math.sqrt(max(square_of(picture) - of_reference, 0.0))

        counts = [max(arguments.samples * 2**power // 16, 1) for power in range(7)]
        pictures = {samples: promin.render(samples)[0] for samples in counts}
        errors = {samples: error_of(picture) for samples, picture in pictures.items()}
        mean = float(np.mean(truth[surfaces]))
        times = {each.name: [] for each in [promin, *peers]}
        noise, means = {}, {}
        for _ in range(arguments.runs):
            for each in [promin, *peers]:
                picture, seconds = each.render(arguments.samples)
                times[each.name].append(seconds)
                noise[each.name] = error_of(picture)
                means[each.name] = float(np.mean(picture[surfaces])) / mean
        paths = arguments.size**2 * arguments.samples / 1e6
        print("| renderer | samples | CPU seconds | million paths a CPU second | RMSE | mean over the reference's |")
        print("|---|---|---|---|---|---|")
        for name, seconds in times.items():
            middle = statistics.median(seconds)
            figures = f"{middle:.2f} | {paths / middle:.3f} | {noise[name]:.5f} | {means[name]:.4f}"
            print(f"| {name} | {arguments.samples} | {figures} |")
        rate = arguments.samples / statistics.median(times[promin.name])
        if arguments.plot:
            a_sample = 1.0 / rate
            points = {promin.name: [(samples * a_sample, error) for samples, error in errors.items()]}
            for peer in peers:
                middle = statistics.median(times[peer.name]) / arguments.samples
                # Multijitter rounds other numbers of samples up.
                squares = [arguments.samples // 4, arguments.samples, 4 * arguments.samples]
                points[peer.name] = [(samples * middle, error_of(peer.render(samples)[0])) for samples in squares]
            plot(arguments.plot, f"{arguments.scene.stem}, depth {arguments.depth}", points)
        for peer in peers:
            needed = samples_for(noise[peer.name], errors) / rate
            ratio = needed / statistics.median(times[peer.name])
            print(f"promin has the RMSE of {peer.name} after {ratio:.2f} of its time.")


if __name__ == "__main__":
    main()
