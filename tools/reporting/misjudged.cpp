// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/misjudged.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/parallel.h"
#include "oracle/verdict.h"

namespace promin::report {
namespace {

constexpr size_t kFewest = 64;

bool is_hit(const Hit& hit) {
  return std::isfinite(hit.t);
}

/// `count` of the values, evenly.
std::vector<size_t> thin_out(const std::vector<size_t>& values, size_t count) {
  if (values.size() <= count) return values;
  std::vector<size_t> some;
  for (size_t i = 0; i < count; ++i) some.push_back(values[i * values.size() / count]);
  return some;
}

}  // namespace

std::vector<size_t> choose_rays(std::span<const Hit> a, std::span<const Hit> b, uint64_t primitive_count,
                                uint64_t most_tests) {
  std::vector<size_t> disputed;
  std::vector<size_t> agreed;
  for (size_t i = 0; i < a.size(); ++i) (is_hit(a[i]) != is_hit(b[i]) ? disputed : agreed).push_back(i);
  const size_t most = std::max(kFewest, static_cast<size_t>(most_tests / std::max<uint64_t>(1, primitive_count)));
  std::vector<size_t> chosen = thin_out(disputed, most);
  const std::vector<size_t> others = thin_out(agreed, most - chosen.size());
  chosen.insert(chosen.end(), others.begin(), others.end());
  return chosen;
}

Misjudged judge_by_oracle(const Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits,
                          std::span<const size_t> chosen) {
  Misjudged total;
  std::mutex mutex;
  for_each_chunk(chosen.size(), 64, 0, [&](size_t begin, size_t end) {
    Misjudged part;
    for (const size_t index : chosen.subspan(begin, end - begin)) {
      const Ray& ray = rays[index];
      const Hit& hit = hits[index];
      const oracle::Ray exact{oracle::Vector(ray.origin), oracle::Vector(ray.direction), ray.tmin, ray.tmax};
      const bool is_there = oracle::is_occluded(scene, exact);
      if (is_there == is_hit(hit)) continue;
      ++(is_there ? part.lost : part.invented);
      // An any-hit ray names no primitive: how far it is off is not known.
      if (is_hit(hit) && hit.object < 0) continue;
      const oracle::Verdict verdict = oracle::judge(scene, exact, {hit.t, hit.object, hit.primitive});
      part.worst_margin = std::max(part.worst_margin, static_cast<double>(verdict.margin));
    }
    const std::lock_guard lock(mutex);
    total.lost += part.lost;
    total.invented += part.invented;
    total.worst_margin = std::max(total.worst_margin, part.worst_margin);
  });
  return total;
}

Misjudged judge_in_closed_mesh(std::span<const Hit> hits) {
  Misjudged result;
  result.lost = static_cast<uint64_t>(std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return !is_hit(h); }));
  return result;
}

}  // namespace promin::report
