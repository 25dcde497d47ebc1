// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/lobe_table.h"

#include <array>
#include <cstdint>

#include "shared/layout.h"

namespace promin {
namespace {

constexpr size_t kSide = layout::LOBE_TABLE_SIDE;

using Entries = std::array<uint32_t, kSide * kSide>;

constexpr Entries kLobes = {
#include "device_scene/lobe_table.def"
};
constexpr Entries kSheens = {
#include "device_scene/sheen_table.def"
};

std::vector<glm::uvec4> make_cells(const Entries& entries) {
  std::vector<glm::uvec4> cells;
  for (size_t y = 0; y + 1 < kSide; ++y) {
    for (size_t x = 0; x + 1 < kSide; ++x) {
      const size_t i = y * kSide + x;
      cells.emplace_back(entries[i], entries[i + 1], entries[i + kSide], entries[i + kSide + 1]);
    }
  }
  return cells;
}

}  // namespace

std::vector<glm::uvec4> make_lobe_table() {
  return make_cells(kLobes);
}

std::vector<glm::uvec4> make_sheen_table() {
  return make_cells(kSheens);
}

}  // namespace promin
