// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace promin {

/// The SPIR-V of what traces and shades a picture.
struct PictureShaders {
  std::span<const uint32_t> camera_stage;
  std::span<const uint32_t> trace_shadow_rays;
  std::span<const uint32_t> follow_paths;
};

/// Of the files of these names in shaders.
PictureShaders picture_shaders();

}  // namespace promin
