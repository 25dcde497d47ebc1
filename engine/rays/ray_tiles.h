// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/unset_vector.h"
#include "rays/ray_order.h"

namespace promin {

/// Orders rays that come row by row, as those of a picture do, be it without some: the shadow rays of what it shows.
/// Keeps the memory of the order for the next ones.
class RayTiler {
 public:
  /// How many rays a packet has that is to hold neighbours.
  static constexpr uint32_t kPacketSize = 4;

  /// The rays' indices, tile by tile of up to 8 rays of 4 rows in a row, where they lie near each other. Most fours in
  /// a row, from the first on, are 2x2 of neighbouring rows, the others mostly of one row. Where rays do not come in
  /// rows of some 50 or more: nothing. It looks at some fifth of the rays, or at far fewer where all rows are as long.
  /// At most 2^32 - 1 rays; the same with any number of threads. Valid until the next call.
  std::span<const uint32_t> tile(std::span<const Ray> rays, const SceneCube& cube);

 private:
  UnsetVector<uint32_t> order_;
};

}  // namespace promin
