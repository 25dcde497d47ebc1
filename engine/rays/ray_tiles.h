// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "core/unset_vector.h"
#include "rays/ray_order.h"

namespace promin {

/// Orders rays that come row by row, as those of a picture do. Some may be missing, as in the shadow rays of what the
/// picture shows. It keeps the memory of the order for the next call.
class RayTiler {
 public:
  /// The number of rays in a packet that is to hold neighbours.
  static constexpr uint32_t kPacketSize = 4;

  /// The rays' indices, tile by tile of up to 8 rays in each of 4 neighbouring rows, where these lie near each other.
  /// Most groups of four indices, from the first on, are 2x2 rays of neighbouring rows; the others are mostly of one
  /// row. Empty where rays do not come in rows of some 50 or more. It looks at some fifth of the rays, or at far fewer
  /// where all rows are equally long. At most 2^32 - 1 rays; the order is the same with any number of threads, and
  /// valid until the next call.
  std::span<const uint32_t> tile(std::span<const Ray> rays, const SceneCube& cube);

 private:
  UnsetVector<uint32_t> order_;
};

}  // namespace promin
