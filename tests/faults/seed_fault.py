#!/usr/bin/env python3
# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Builds the shaders with a fault in them, for tests of the tests: a fault removes a part of the robustness, which must
make a test fail.

seed_fault.py FAULT SHADERS INCLUDE GLSLANG OUT KERNEL...: copies the folder SHADERS and the .comp files KERNEL into
OUT, puts the fault in, and compiles the kernels to OUT/*.spv, with the tables in INCLUDE. If the code that a fault
changes no longer exists, the script fails."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

# fma(a, b, c) has one rounding, as hardware gives it, in fp32 alone; Dekker's splitting gives the product's own error.
FUSED = """
float fused(float a, float b, float c) {
  precise float split_a = 4097.0 * a;
  precise float a_hi = split_a - (split_a - a);
  precise float a_lo = a - a_hi;
  precise float split_b = 4097.0 * b;
  precise float b_hi = split_b - (split_b - b);
  precise float b_lo = b - b_hi;
  precise float product = a * b;
  precise float error = ((a_hi * b_hi - product) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo;
  precise float sum = (product + c) + error;
  return sum;
}
"""

# FAULTS maps a fault's name to files, and each file to pairs of a regular expression and its replacement.
FAULTS = {
    "unpadded_boxes": {
        "trace/make_ray.glsl": [
            (r"BOX_PADDING = [^;]*;", "BOX_PADDING = 0.0;"),
            (r"ORIGIN_PADDING = [^;]*;", "ORIGIN_PADDING = 0.0;"),
        ]
    },
    "fixed_epsilon": {"shade/secondary.glsl": [(r"position \+ lift \*", "position + 1e-4 *")]},
    "one_sided_fma": {
        "trace/primitives/triangle.glsl": [
            (r"(ShearedTriangle shear_triangle)", FUSED + r"\1"),
            (r"= c2\.x \* b2\.y - c2\.y \* b2\.x;", "= fused(c2.x, b2.y, -(c2.y * b2.x));"),
            (r"= a2\.x \* c2\.y - a2\.y \* c2\.x;", "= fused(a2.x, c2.y, -(a2.y * c2.x));"),
            (r"= b2\.x \* a2\.y - b2\.y \* a2\.x;", "= fused(b2.x, a2.y, -(b2.y * a2.x));"),
        ]
    },
    "instance_rotated_first": {
        "trace/change_level.glsl": [
            (r"= upper_rays\[slot\]\.origin - map\.origin;", "= upper_rays[slot].origin;"),
            (r"(times_rows\([^;]*, near\)),", r"\1 - times_rows(map.r0, map.r1, map.r2, map.origin),"),
        ]
    },
    "instance_lift_small": {
        "trace/instances.glsl": [(r"UNIT_ROUNDOFF \* \(h \* own_lift", "0.02 * UNIT_ROUNDOFF * (h * own_lift")]
    },
    "instance_normals_by_e": {
        "trace/instances.glsl": [
            (r"times_columns\(map[^;]*, own_normal\);", "to_world_direction(look, own_normal);"),
        ]
    },
    "ties_reversed": {"trace/packet.glsl": [(r"limits\[slot\] && order < found", "limits[slot] && order > found")]},
    "instance_t_unscaled": {"trace/level.glsl": [(r"t \* to_world\[slot\];", "t;")]},
    "nothing_precise": {"trace/primitives/triangle.glsl": [(r"\bprecise ", "")]},
    # These are faults of pictures (tests/gpu/boards_test.cpp).
    "srgb_is_linear": {"shade/textures.glsl": [(r"return vec3\(code\.x <= 0\.04045[^;]*;", "return code;")]},
    "srgb_after_filter": {
        "shade/textures.glsl": [
            (r"if \(is_srgb\) numbers.xyz = decode_srgb\(numbers.xyz\);", ""),
            (
                r"(precise vec4 result = upper [^;]*;)",
                r"\1 if (is_srgb) result.xyz = decode_srgb(result.xyz);",
            ),
        ]
    },
    "wraps_swapped": {"shade/textures.glsl": [(r"mode == WRAP_REPEAT \? repeated", "mode == WRAP_MIRRORED ? repeated")]},
    "one_uv_set": {"shade/textures.glsl": [(r"is_second \? place\.uvs\.zw : place\.uvs\.xy", "place.uvs.xy")]},
    "transform_transposed": {"shade/textures.glsl": [(r"slot\.to_u\.y \* st\.y", "slot.to_v.x * st.y")]},
    "green_flipped": {
        "shade/shading.glsl": [(r"scaled\.y \* across", "-scaled.y * across")],
    },
    "normals_unscaled": {"shade/shading.glsl": [(r"\(2\.0 \* texel\.xy - 1\.0\) \* scale", "2.0 * texel.xy - 1.0")]},
    "occlusion_dims_sources": {
        "shade/materials/metallic_roughness.glsl": [(r"albedo_of\(point\) \* INVERSE_PI", "point.occlusion * \\g<0>")]
    },
    "cutoff_excluded": {"shade/cutouts.glsl": [(r"< material\.cover\.y", "<= material.cover.y")]},
    "masks_in_shadows_alone": {"shade/cutouts.glsl": [(r"if \(!has\(FEATURE_HOLES\)", "if (passes_backs || !has(FEATURE_HOLES)")]},
    "shadows_without_holes": {"shade/cutouts.glsl": [(r"if \(!has\(FEATURE_HOLES\)", "if (!passes_backs || !has(FEATURE_HOLES)")]},
    "fronts_culled": {"shade/cutouts.glsl": [(r"facing > 0\.0", "facing < 0.0")]},
    "alpha_premultiplied": {"picture/path.glsl": [(r"weight = coverage \* weight;", ";")]},
    "edges_counted_twice": {"shade/cutouts.glsl": [(r"&& is_on_open_edge &&", "&& false &&")]},
    "equal_t_passed": {"trace/packet.glsl": [(r"t < passed_t\[slot\] \|\|", "t <= passed_t[slot] ||")]},
    "coat_bent_by_normals": {
        "shade/shading.glsl": [(r"point\.coat = seen_coat\(point\.coat, direction\);",
                          "{ Coat bent = point.coat; bent.normal = point.normal; point.coat = seen_coat(bent, direction); }")]
    },
    # These are faults of levels (tests/gpu/levels_test.cpp).
    "levels_of_fronts": {"shade/textures.glsl": [(r" / max\(abs\(facing\), 1\.0 / 64\.0\)", "")]},
    "levels_a_little_fine": {"shade/textures.glsl": [(r"log2_about\(texels\)\);", "log2_about(texels)) - 0.005;")]},
    "mirrors_keep_cones": {"picture/path.glsl": [(r"path\.cone_spread = spread;", ";")]},
    "mirrored_masks_anew": {"picture/follow_paths.comp": [(r"sight_width = load_record[^;]*;", "sight_width = 0.0;")]},
    "shadows_take_levels": {
        "picture/camera_stage.comp": [(r"sight_width = 0\.0;\s*sight_spread = 0\.0;", "sight_width = CAMERA.look.w + 0.05;")]
    },
    # These are faults of properties that few materials have (tests/gpu/oracle_picture_test.cpp).
    "behind_seen_from_front": {
        "shade/shading.glsl": [(r"lift_off\(point\.position, -point", "lift_off(point.position, point")]
    },
    "films_seen_from_above": {"shade/shading.glsl": [(r"put_film\(point, cosine\)", "put_film(point, 1.0)")]},
    "grain_unbent": {"shade/anisotropy.glsl": [(r"max_abs\(bent\) == 0\.0 \? point\.normal : bent", "point.normal")]},
    "sky_behind_in_front": {"shade/materials/metallic_roughness.glsl": [(r"ambient_at\(-point", "ambient_at(point")]},
    "grain_turned": {"shade/anisotropy.glsl": [(r"vec2\(along, across\)", "vec2(across, along)")]},
    # These are faults of points of lights (tests/gpu/soft_light_test.cpp).
    "light_density_off": {"shade/lights/ball.glsl": [(r"share = 2\.0 / ", "share = 2.04 / ")]},
    "light_order_unshuffled": {
        "shade/samples.glsl": [(r"uint shuffled = [^;]*;", "uint shuffled = sample_number;")]
    },
    "flat_cosine_left_out": {"shade/lights/area.glsl": [(r"area \* z / \(d2 \* sqrt\(d2\)\)", "area / d2")]},
    "flat_angle_off": {"shade/lights/area.glsl": [(r"strength = solid_angle;", "strength = 1.02 * solid_angle;")]},
    "lobe_density_off": {"shade/shading.glsl": [(r"6\.28318531 \* seen\.cap", "6.4 * seen.cap")]},
    # These are faults of the environment as a source (tests/gpu/sky_light_test.cpp).
    "sky_density_off": {"shade/sky_light.glsl": [(r"/ \(4\.0 \* side", "/ (4.08 * side")]},
    "dome_density_off": {"shade/sky_light.glsl": [(r"by_sky \* INVERSE_PI", "1.02 * \\g<0>")]},
    "sky_lobes_left_out": {"shade/sky_light.glsl": [(r"density \+= shares\.material[^;]*;", ";")]},
    "sky_squares_swapped": {"shade/sky_light.glsl": [(r"\(is_right \? 1u : 0u\)", "(is_right ? 0u : 1u)")]},
    "sky_horizon_hard": {"shade/sky_light.glsl": [(r"SHARE_OF_WIDEST \* widest", "0.0"), (r"USUAL_SQUARE\)", "1e-9)")]},
    # These are faults of scattered rays (tests/gpu/scattering_test.cpp).
    "scattering_density_off": {"picture/scatter.glsl": [(r"= sum / width;", "= 1.02 * sum / width;")]},
    "scattering_cosine_left_out": {
        "shade/sky_light.glsl": [(r"sqrt\(1\.0 - disc\.z\) \* normal", "(1.0 - disc.z) * normal")]
    },
    "scattering_unshuffled": {"picture/scatter.glsl": [(r"FIRST_DIRECTION_PAIR \+ step", "FIRST_DIRECTION_PAIR")]},
    "facets_unmasked": {"picture/scatter.glsl": [(r"l \* \(v \+ v_length\) / both", "1.0")]},
    "roughness_unbounded": {"picture/scatter.glsl": [(r"is_diffused \? ROUGHNESS_AFTER_DIFFUSION : 0\.0", "0.0")]},
    # These are faults of emissive surfaces as sources (tests/gpu/emitters_test.cpp).
    "lamp_angle_off": {
        "shade/emitters.glsl": [(r"\? seen\.solid_angle : 6\.28318531", "? 1.02 * seen.solid_angle : 6.4")]
    },
    "lamp_area_off": {"shade/emitters.glsl": [(r"0\.5 \* abs\(seen\.height\)", "0.51 * abs(seen.height)")]},
    "lamp_chance_off": {"shade/emitters.glsl": [(r"/ emitter\.chance;", "/ (1.02 * emitter.chance);")]},
    "lamp_ball_off": {"shade/emitters.glsl": [(r"6\.28318531 \* cap;", "6.4 * cap;")]},
    "lamp_rect_off": {
        "shade/emitters.glsl": [(r"> doubt \? sampled\.strength", "> doubt ? 1.02 * sampled.strength")]
    },
    "lamp_back_shines": {"shade/emitters.glsl": [(r" && !is_dark", "")]},
    "lens_turned": {"picture/camera.glsl": [(r"disc\.x \* CAMERA\.right", "disc.y * CAMERA.right")]},
    # These are faults of glass (tests/gpu/oracle_picture_test.cpp).
    "absorption_per_face": {"shade/glass.glsl": [(r"= -absorption \* way;", "= -absorption;")]},
    "colors_swapped": {"shade/glass.glsl": [(r"color == RED \? -", "color == BLUE ? -")]},
    "glass_seen_from_outside": {"shade/faces.glsl": [(r"face\.from <= face\.to \? cosine : beyond", "cosine")]},
    "media_kept": {"shade/glass.glsl": [(r"= leave\(media, medium\);", "= media;")]},
    "nested_faces_bend": {"shade/glass.glsl": [(r"if \(is_last \|\|[^)]*\)\) \{", "{")]},
    "refraction_inverted": {"shade/faces.glsl": [(r"float ratio = face\.from / face\.to;", "float ratio = face.to / face.from;")]},
    "shadows_untinted": {"shade/light_way.glsl": [(r"coverage \* share_through\([^)]*\)", "coverage")]},
    "total_reflection_dark": {"shade/faces.glsl": [(r"\) mirror \+= record\.transmission\.xyz;", ") ;")]},
    "through_unweighted": {"picture/tree.glsl": [(r"= path\.weight \* point\.glass\.through;", "= path.weight;")]},
}


def main():
    fault = sys.argv[1]
    shaders, include, glslang, out, *kernels = map(pathlib.Path, sys.argv[2:])
    folder = out / "shaders"
    shutil.rmtree(out, ignore_errors=True)
    shutil.copytree(shaders, folder)
    sources = [folder / os.path.relpath(kernel, shaders) for kernel in kernels]
    for i, kernel in enumerate(kernels):
        if not sources[i].exists():
            sources[i] = pathlib.Path(shutil.copy(kernel, folder))
    for file, changes in FAULTS[fault].items():
        text = (folder / file).read_text()
        for pattern, replacement in changes:
            text, count = re.subn(pattern, replacement, text)
            if count == 0:
                sys.exit(f"seed_fault.py: error: {file} has no {pattern} for the fault {fault}; mend the pattern")
        (folder / file).write_text(text)
    for source in sources:
        spirv = out / (source.stem + ".spv")
        options = ["--quiet", "-V", "--target-env", "vulkan1.1", f"-I{folder}", f"-I{include}"]
        subprocess.run([glslang, *options, "-o", spirv, source], check=True)


main()
