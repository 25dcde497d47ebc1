// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace promin {

/// The SPIR-V of both stages of a picture.
struct PictureShaders {
  std::span<const uint32_t> camera_stage;
  std::span<const uint32_t> mirror_stage;
};

/// The SPIR-V of shaders/camera_stage.comp and shaders/mirror_stage.comp.
PictureShaders picture_shaders();

}  // namespace promin
