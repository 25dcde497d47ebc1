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

/// Adds the hits of primitives that are not in the tree, because they are copies of one that is, to lists of hits.
class CopiedHits {
 public:
  CopiedHits() = default;
  CopiedHits(const DroppedCopies& dropped, const PrimitiveNumbers& numbers);

  bool empty() const { return copies_.empty(); }

  /// Hands a list on with the hits of copies, in parts of whole rays that have hits of `budget_bytes` together, or of
  /// one ray. `list` has those of the rays' other hits, in the order of hits.
  void list(const HitList& list, const HitListSink& sink, uint64_t budget_bytes) const;

 private:
  using Id = std::pair<int32_t, int32_t>;

  /// Appends the hits of a ray with those of copies, in the order of hits.
  void append(std::span<const Hit> hits, std::vector<Hit>& all) const;

  /// By object and primitive those that are copies of it.
  std::map<Id, std::vector<Id>> copies_;
};

}  // namespace promin
