// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/render/copied_hits.h"

#include <algorithm>
#include <tuple>

namespace promin {

CopiedHits::CopiedHits(const DroppedCopies& dropped, const PrimitiveNumbers& numbers) {
  const auto id_of = [&](uint32_t order) {
    const PrimitiveId id = primitive_of_order(numbers, order);
    return Id(static_cast<int32_t>(id.object), static_cast<int32_t>(id.primitive));
  };
  for (const auto& [first, others] : dropped.by_first) {
    std::vector<Id>& ids = copies_[id_of(first)];
    for (const uint32_t other : others) ids.push_back(id_of(other));
  }
}

void CopiedHits::append(std::span<const Hit> hits, std::vector<Hit>& all) const {
  const size_t first = all.size();
  bool has_copies = false;
  for (Hit hit : hits) {
    all.push_back(hit);
    const auto found = copies_.find({hit.object, hit.primitive});
    if (found == copies_.end()) continue;
    has_copies = true;
    for (const auto& [object, primitive] : found->second) {
      hit.object = object;
      hit.primitive = primitive;
      all.push_back(hit);
    }
  }
  if (!has_copies) return;
  std::stable_sort(all.begin() + static_cast<ptrdiff_t>(first), all.end(), [](const Hit& a, const Hit& b) {
    return std::tuple(a.t, a.object, a.primitive) < std::tuple(b.t, b.object, b.primitive);
  });
}

void CopiedHits::list(const HitList& list, const HitListSink& sink, uint64_t budget_bytes) const {
  const size_t ray_count = list.offsets.size() - 1;
  std::vector<uint64_t> offsets = {0};
  std::vector<Hit> hits;
  uint64_t first_ray = list.first_ray;
  const auto hand_on = [&] {
    sink({first_ray, offsets, hits});
    first_ray += offsets.size() - 1;
    offsets = {0};
    hits.clear();
  };
  for (size_t ray = 0; ray < ray_count; ++ray) {
    const size_t before = hits.size();
    append(list.hits.subspan(list.offsets[ray], list.offsets[ray + 1] - list.offsets[ray]), hits);
    if (offsets.size() > 1 && hits.size() * sizeof(Hit) > budget_bytes) {
      // This ray begins the next part.
      std::vector<Hit> own(hits.begin() + static_cast<ptrdiff_t>(before), hits.end());
      hits.resize(before);
      hand_on();
      hits = std::move(own);
    }
    offsets.push_back(hits.size());
  }
  hand_on();
}

}  // namespace promin
