// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "support/thorough.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {

/// Options that change how a picture is traced, but none of its bits: without texel buffers, with holes
/// that are looked up at once or later, with packets and pieces of other sizes, with the trees of all builders. Only
/// thorough tests and RendererTest use packets of 2, because their kernels take as long to compile as those of 4.
inline std::vector<TunedRendererOptions> ways_of_tracing() {
  std::vector<TunedRendererOptions> ways(1);
  ways.back().avoids_texels = true;
  for (const bool waits : {false, true}) ways.emplace_back().waits_with_holes = waits;
  for (const uint32_t packet : cases_of<uint32_t>({1, 4, 2}, 2)) {
    ways.emplace_back().packet_size = packet;
    ways.back().blocks_per_dispatch = 5 * packet;
  }
  for (const std::string_view builder : builder_names()) ways.emplace_back().builder = builder;
  return ways;
}

}  // namespace promin::test
