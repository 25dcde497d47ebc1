// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/film_records.h"

#include <algorithm>
#include <bit>

#include "core/parallel.h"
#include "shared/layout.h"

namespace promin {
namespace {

vec3 vec3_of(const uvec4& bits) {
  return {std::bit_cast<float>(bits.x), std::bit_cast<float>(bits.y), std::bit_cast<float>(bits.z)};
}

}  // namespace

FilmRecords::FilmRecords(FeatureMask features)
    : first_part(features.has_any(layout::FEATURE_AOVS) ? layout::AOV_RECORDS : 1),
      first_ids(first_part + (features.has_any(layout::FEATURE_LIGHT_AOVS) ? layout::PART_RECORDS : 0)),
      // A sample of a list has a single id, in the record of its sum.
      first_range(first_ids +
                  (features.has_any(layout::FEATURE_SAMPLE_IDS) && !features.has_any(layout::FEATURE_LISTED_SAMPLES)
                       ? layout::SAMPLE_IDS / 4
                       : 0)),
      unlit(first_range + (features.has_any(layout::FEATURE_SAMPLE_RANGES) ? layout::RANGE_RECORDS : 0)),
      count(unlit + (features.has_any(layout::FEATURE_UNLIT_SHARE) ? 1 : 0)) {}

dvec3 ReadFilm::part(uint32_t which, size_t pixel) const {
  return {vec3_of(record(layout.first_part + which, pixel))};
}

ColorRange ReadFilm::range(size_t pixel) const {
  return {vec3_of(record(layout.first_range + layout::RANGE_LEAST, pixel)),
          vec3_of(record(layout.first_range + layout::RANGE_LARGEST, pixel))};
}

vec4 ReadFilm::unlit(size_t pixel) const {
  const uvec4& bits = record(layout.unlit, pixel);
  return {vec3_of(bits), std::bit_cast<float>(bits.w)};
}

void read_unlit(const ReadFilm& film, size_t pixel_count, std::vector<vec4>& unlit) {
  if (!film.layout.has_unlit()) return;
  unlit.resize(pixel_count);
  for_each_pixel(pixel_count, [&](size_t i) { unlit[i] = film.unlit(i); });
}

void read_surfaces(const ReadFilm& film, const PrimitiveNumbers& numbers, DepthKind depth_kind, size_t first,
                   Aovs& aovs) {
  for_each_pixel(film.pixel_count, [&](size_t i) {
    const uint32_t order = film.record(0, i).w;
    const uvec4& normal = film.record(layout::AOV_NORMAL, i);
    const uvec4& albedo = film.record(layout::AOV_ALBEDO, i);
    const vec3 measures = vec3_of(film.record(layout::AOV_MEASURES, i));
    PrimitiveId id{Aovs::kNoId, Aovs::kNoId};
    if (order != layout::NO_ORDER) id = primitive_of_order(numbers, order);
    // The members of this struct have the names of the table of AOVs.
    const struct {
      float depth;
      vec3 position;
      vec3 normal;
      vec3 shading_normal;
      vec2 uv;
      vec3 albedo;
      uint32_t object;
      uint32_t primitive;
      uint32_t material;
    } told{depth_kind == DepthKind::kRay ? std::bit_cast<float>(normal.w) : measures.z,
           vec3_of(film.record(layout::AOV_POSITION, i)),
           vec3_of(normal),
           vec3_of(film.record(layout::AOV_SHADING_NORMAL, i)),
           vec2(measures),
           vec3_of(albedo),
           id.object,
           id.primitive,
           albedo.w};
    // If an AOV of a surface has no code that reads it, this does not compile.
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) PROMIN_READ_##SOURCE(FIELD)
#define PROMIN_READ_kSurface(FIELD) \
  if (!aovs.FIELD.empty()) aovs.FIELD[first + i] = told.FIELD;
#define PROMIN_READ_kParts(FIELD)
#define PROMIN_READ_kSteps(FIELD)
#define PROMIN_READ_kSampling(FIELD)
#define PROMIN_READ_kUnlit(FIELD)
#define PROMIN_READ_kOcclusion(FIELD)
#define PROMIN_READ_kMotion(FIELD)
#include "promin/kinds/aovs.def"
#undef PROMIN_READ_kSurface
#undef PROMIN_READ_kParts
#undef PROMIN_READ_kSteps
#undef PROMIN_READ_kSampling
#undef PROMIN_READ_kUnlit
#undef PROMIN_READ_kOcclusion
#undef PROMIN_READ_kMotion
  });
}

void read_steps(const ReadFilm& film, size_t first, Aovs& aovs) {
  for (size_t i = 0; i < film.pixel_count; ++i) aovs.steps[first + i] = film.record(layout::AOV_MEASURES, i).w;
}

void LightParts::add(const ReadFilm& film, size_t pixel) {
  for (uint32_t part = 0; part < layout::LIGHT_PARTS; ++part) sums[part] += film.part(part, pixel);
  background_share += std::bit_cast<float>(film.record(film.layout.first_part + layout::PART_BACKGROUND, pixel).w);
}

void LightParts::put(uint32_t samples, size_t pixel, Aovs& aovs, vec3& color) const {
  const auto put_part = [&](uint32_t part, std::vector<vec3>& values) {
    if (!values.empty()) values[pixel] = vec3(sums[part] / static_cast<double>(samples));
  };
  put_part(layout::PART_EMISSION, aovs.emission);
  put_part(layout::PART_DIRECT, aovs.direct);
  put_part(layout::PART_INDIRECT, aovs.indirect);
  put_part(layout::PART_REFLECTION, aovs.reflection);
  put_part(layout::PART_TRANSMISSION, aovs.transmission);
  put_part(layout::PART_BACKGROUND, aovs.background);
  if (aovs.alpha.empty()) return;
  aovs.alpha[pixel] = static_cast<float>(std::clamp(1.0 - background_share / samples, 0.0, 1.0));
  const dvec3& background = sums[layout::PART_BACKGROUND];
  if (background == dvec3(0.0)) return;
  // Where only the background is visible, the difference is exactly 0. Rounding may leave a small difference elsewhere.
  const vec3 seen = vec3(background / static_cast<double>(samples));
  color = aovs.alpha[pixel] == 0.0F ? vec3(0.0F) : glm::max(color - seen, vec3(0.0F));
}

void CoverageTally::Counts::add(uint32_t id, uint32_t samples) {
  for (uint32_t i = 0; i < size_; ++i) {
    if (at(i).id != id) continue;
    at(i).samples += samples;
    return;
  }
  if (size_ >= kFew) more_.emplace_back();
  at(size_++) = {id, samples};
}

void CoverageTally::add(size_t pixel, uint32_t object) {
  if (object != Coverage::kNoId) counts_[pixel].add(object, 1);
}

CoverageRanks CoverageTally::rank(const Counts& counts, uint32_t samples) {
  CoverageRanks ranks;
  // The ids are inserted by descending coverage; at equal coverage the lower number comes first. Ids beyond the last
  // rank are dropped.
  std::array<Count, kCoverageRanks> ranked;
  const auto is_before = [](const Count& a, const Count& b) {
    return a.samples != b.samples ? a.samples > b.samples : a.id < b.id;
  };
  for (uint32_t i = 0; i < counts.size(); ++i) {
    Count moving = counts[i];
    for (Count& place : ranked) {
      if (is_before(moving, place)) std::swap(moving, place);
    }
  }
  for (size_t i = 0; i < ranks.size() && ranked[i].samples > 0; ++i) {
    ranks[i] = {ranked[i].id, static_cast<float>(ranked[i].samples) / static_cast<float>(samples)};
  }
  return ranks;
}

void CoverageTally::put(size_t tallied, uint32_t samples, size_t pixel, Aovs& aovs) const {
  const Counts& objects = counts_[tallied];
  Counts materials;
  for (uint32_t i = 0; i < objects.size(); ++i) {
    materials.add(material_of_object_[objects[i].id], objects[i].samples);
  }
  aovs.object_coverage[pixel] = rank(objects, samples);
  aovs.material_coverage[pixel] = rank(materials, samples);
}

}  // namespace promin
