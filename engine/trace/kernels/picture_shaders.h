// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace promin {

/// The SPIR-V of the kernels that trace and shade a picture.
struct PictureShaders {
  std::span<const uint32_t> camera_stage;
  std::span<const uint32_t> trace_shadow_rays;
  std::span<const uint32_t> follow_paths;
};

/// Returns the SPIR-V of the files of these names in shaders.
PictureShaders picture_shaders();

}  // namespace promin
