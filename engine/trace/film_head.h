// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "layout.h"

namespace promin {

/// One for each lane of a block.
using Counters = std::array<uvec4, layout::BLOCK_SIZE * layout::BLOCK_SIZE>;

/// Head of the film buffer (shaders/film.glsl).
struct FilmHead {
  layout::Dispatch dispatch{};
  layout::StreamState stream{};
  Counters ray_counts{};
  Counters pass_counts{};
};
static_assert(sizeof(FilmHead) == layout::FILM_HEAD_TEXELS * sizeof(uvec4));

}  // namespace promin
