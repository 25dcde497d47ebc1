// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/misjudged.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "oracle/verdict.h"

namespace promin::report {
namespace {

constexpr size_t kFewest = 64;

bool is_hit(const Hit& hit) {
  return std::isfinite(hit.t);
}

oracle::Ray exact_ray(const Ray& ray) {
  return {oracle::Vector(ray.origin), oracle::Vector(ray.direction), ray.tmin, ray.tmax};
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

std::vector<uint8_t> ask_oracle(const world::Scene& scene, std::span<const Ray> rays, std::span<const size_t> chosen) {
  std::vector<uint8_t> is_there(chosen.size());
  for_each_chunk(chosen.size(), 64, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) is_there[i] = oracle::is_occluded(scene, exact_ray(rays[chosen[i]])) ? 1 : 0;
  });
  return is_there;
}

Misjudged judge_by_oracle(const world::Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits,
                          std::span<const size_t> chosen, std::span<const uint8_t> is_there) {
  Misjudged result;
  for (size_t i = 0; i < chosen.size(); ++i) {
    const Hit& hit = hits[chosen[i]];
    if ((is_there[i] != 0) == is_hit(hit)) continue;
    ++(is_hit(hit) ? result.invented : result.lost);
    if (is_hit(hit) && hit.object < 0) continue;
    const oracle::Verdict verdict =
        oracle::judge(scene, exact_ray(rays[chosen[i]]), {hit.t, hit.object, hit.primitive});
    result.worst_margin = std::max(result.worst_margin, static_cast<double>(verdict.margin));
  }
  return result;
}

Misjudged judge_in_closed_mesh(std::span<const Hit> hits) {
  Misjudged result;
  result.lost = static_cast<uint64_t>(std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return !is_hit(h); }));
  return result;
}

}  // namespace promin::report
