// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/unset_vector.h"
#include "rays/ray_order.h"

namespace promin {

/// Orders rays that are given row by row, like the rays of a picture. Some rays may be missing, as for shadow rays of
/// visible surfaces. The object keeps its memory for the next call.
class RayTiler {
 public:
  /// The number of neighbouring rays in a packet.
  static constexpr uint32_t kPacketSize = 4;

  /// Returns the rays' indices in tiles of up to 8 rays in each of 4 neighbouring rows, if these are close together.
  /// Most groups of four indices, counted from the first, are 2x2 rays of neighbouring rows; most other groups are rays
  /// of one row. The result is empty if the rays do not form rows of about 50 rays or more. The function reads about a
  /// fifth of the rays, or far fewer if all rows have the same length. There may be at most 2^32 - 1 rays. The order is
  /// the same for every number of threads, and valid until the next call.
  std::span<const uint32_t> tile(std::span<const Ray> rays, const SceneCube& cube);

 private:
  UnsetVector<uint32_t> order_;
};

}  // namespace promin
