// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bvh/primitive_numbers.h"
#include "promin/aovs.h"
#include "promin/view.h"
#include "scene/features.h"
#include "trace/film/pixel_estimate.h"

// Decodes the records of a film's pixels (shaders/shared/layout.h, from AOV_* on). This code does not use Vulkan.
namespace promin {

/// The layout of a pixel's records on a film with these features. Records of a pixel are `pixel_count` apart.
struct FilmRecords {
  explicit FilmRecords(FeatureMask features);

  /// Index of the first record of PART_*, of the ids of samples, and of RANGE_*.
  uint32_t first_part;
  uint32_t first_ids;
  uint32_t first_range;
  /// Index of the record of unlit surfaces, with FEATURE_UNLIT_SHARE.
  uint32_t unlit;
  uint32_t count;

  bool has_unlit() const { return unlit < count; }
};

/// The records of a window of a picture, copied from a film.
struct ReadFilm {
  std::span<const uvec4> records;
  size_t pixel_count;
  FilmRecords layout;

  const uvec4& record(uint32_t which, size_t pixel) const { return records[which * pixel_count + pixel]; }
  /// Returns the sum over all samples of one part of the light.
  dvec3 part(uint32_t which, size_t pixel) const;
  /// Returns the range of the samples' colours, with FEATURE_SAMPLE_RANGES.
  ColorRange range(size_t pixel) const;
  /// Returns the visible unlit surfaces in the form of Aovs::unlit, but summed over samples. Requires
  /// FEATURE_UNLIT_SHARE.
  vec4 unlit(size_t pixel) const;
};

/// Reads AOVs of surfaces and steps into the members of `aovs` that have values. The film's first pixel is pixel
/// `first` of the AOVs.
void read_surfaces(const ReadFilm& film, const PrimitiveNumbers& numbers, DepthKind depth_kind, size_t first,
                   Aovs& aovs);
void read_steps(const ReadFilm& film, size_t first, Aovs& aovs);

/// Reads the unlit surfaces of the first pixels of a film with FEATURE_UNLIT_SHARE. Does nothing for other films.
void read_unlit(const ReadFilm& film, size_t pixel_count, std::vector<vec4>& unlit);

/// The parts of a pixel's light, summed over samples.
struct LightParts {
  dvec3 sums[layout::LIGHT_PARTS] = {};
  /// Number of samples that see the background, weighted by the transparency in front of it.
  double background_share = 0.0;

  /// Adds the parts of the light of a pixel of the film.
  void add(const ReadFilm& film, size_t pixel);
  /// Stores the parts' averages in the selected AOVs of a pixel. With Aovs::alpha it removes the background from
  /// `color`.
  void put(uint32_t samples, size_t pixel, Aovs& aovs, vec3& color) const;
};

/// Counts the objects that the samples of pixels see.
class CoverageTally {
 public:
  /// `material_of_object` is indexed by object and must outlive this object.
  CoverageTally(size_t pixel_count, std::span<const uint32_t> material_of_object)
      : material_of_object_(material_of_object), counts_(pixel_count) {}

  /// Counts a sample. `object` may be Coverage::kNoId. Several threads may call it for different pixels.
  void add(size_t pixel, uint32_t object);
  void put(size_t tallied, uint32_t samples, size_t pixel, Aovs& aovs) const;

 private:
  struct Count {
    uint32_t id = Coverage::kNoId;
    uint32_t samples = 0;
  };
  /// Numbers of samples by id. Most pixels show few objects, for which no heap memory is needed.
  class Counts {
   public:
    void add(uint32_t id, uint32_t samples);
    uint32_t size() const { return size_; }
    const Count& operator[](uint32_t i) const { return i < kFew ? few_[i] : more_[i - kFew]; }

   private:
    static constexpr uint32_t kFew = 3;
    Count& at(uint32_t i) { return i < kFew ? few_[i] : more_[i - kFew]; }

    std::array<Count, kFew> few_;
    uint32_t size_ = 0;
    std::vector<Count> more_;
  };
  static CoverageRanks rank(const Counts& counts, uint32_t samples);

  std::span<const uint32_t> material_of_object_;
  std::vector<Counts> counts_;
};

}  // namespace promin
