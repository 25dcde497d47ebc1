// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/lobe_table.h"

#include <array>
#include <cstdint>

#include "layout.h"

namespace promin {
namespace {

constexpr size_t kSide = layout::LOBE_TABLE_SIDE;

constexpr std::array<uint32_t, kSide * kSide> kEntries = {
#include "device_scene/lobe_table.def"
};

}  // namespace

std::vector<glm::uvec4> make_lobe_table() {
  std::vector<glm::uvec4> cells;
  for (size_t y = 0; y + 1 < kSide; ++y) {
    for (size_t x = 0; x + 1 < kSide; ++x) {
      const size_t i = y * kSide + x;
      cells.emplace_back(kEntries[i], kEntries[i + 1], kEntries[i + kSide], kEntries[i + kSide + 1]);
    }
  }
  return cells;
}

}  // namespace promin
