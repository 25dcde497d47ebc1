// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/math.h"

namespace promin {

/// A linear RGB picture; row 0 is the top.
struct Image {
  uvec2 size{0};
  std::vector<vec3> pixels;

  const vec3& at(uint32_t x, uint32_t y) const { return pixels[static_cast<size_t>(y) * size.x + x]; }
  vec3& at(uint32_t x, uint32_t y) { return pixels[static_cast<size_t>(y) * size.x + x]; }
};

/// Name and value pairs that an EXR carries in its header, e.g. {"promin:scene", "showcase.gltf"}.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// Whether write_image knows the file's ending: .exr or .png.
bool is_writable_format(const std::filesystem::path& file);

/// Writes .exr (R, G, B linear fp32, with `metadata`) or .png (sRGB, 8 bit, clamped). Atomic: the picture is written
/// to a temporary file beside the target and renamed; on failure the target is as it was. Throws RunError.
void write_image(const std::filesystem::path& file, const Image& image, const Metadata& metadata = {});

/// Reads R, G, B of any format OpenImageIO knows, as linear fp32 without conversion. Throws InputError.
Image read_image(const std::filesystem::path& file);

/// Linear light to the sRGB transfer curve, in double on the host (IEC 61966-2-1); clamps to [0, 1], NaN becomes 0.
float encode_srgb(float linear);

}  // namespace promin
