// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "bvh/primitive_numbers.h"
#include "device_scene/drop_copies.h"
#include "promin/caster.h"

namespace promin {

/// Adds to lists of hits the hits of primitives that are not in the tree because they are copies of other primitives.
class CopiedHits {
 public:
  CopiedHits() = default;
  CopiedHits(const DroppedCopies& dropped, const PrimitiveNumbers& numbers);

  bool empty() const { return copies_.empty(); }

  /// Passes a list with the hits of copies to `sink`, in parts of whole rays. A part has at most `budget_bytes` of
  /// hits, but at least one ray. `list` has the other hits of the rays in sorted order.
  void list(const HitList& list, const HitListSink& sink, uint64_t budget_bytes) const;

 private:
  using Id = std::pair<int32_t, int32_t>;

  /// Appends the hits of a ray and the hits of copies in sorted order.
  void append(std::span<const Hit> hits, std::vector<Hit>& all) const;

  /// The copies of each primitive, indexed by object and primitive.
  std::map<Id, std::vector<Id>> copies_;
};

}  // namespace promin
