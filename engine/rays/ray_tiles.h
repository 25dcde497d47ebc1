// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/unset_vector.h"
#include "rays/ray_order.h"

namespace promin {

/// Orders rays that are given row by row, like those of a picture. Some may be missing, as for shadow rays of visible
/// surfaces. It keeps its memory for the next call.
class RayTiler {
 public:
  /// The number of neighbouring rays in a packet.
  static constexpr uint32_t kPacketSize = 4;

  /// Returns the rays' indices in tiles of up to 8 rays in each of 4 neighbouring rows, if these are close together.
  /// Most groups of four indices, starting at the first, are 2x2 rays of neighbouring rows; most others are of one row.
  /// Empty if the rays do not form rows of about 50 or more. It reads about a fifth of the rays, or far fewer if all
  /// rows are equally long. At most 2^32 - 1 rays; the order is the same with any number of threads, and valid until
  /// the next call.
  std::span<const uint32_t> tile(std::span<const Ray> rays, const SceneCube& cube);

 private:
  UnsetVector<uint32_t> order_;
};

}  // namespace promin
