// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/aovs.h"

namespace promin {

AovSet AovSet::of_surfaces() {
  AovSet set;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) \
  set.FIELD = AovSource::SOURCE == AovSource::kSurface || AovSource::SOURCE == AovSource::kSampling;
#include "promin/kinds/aovs.def"
  return set;
}

bool AovSet::has_any(AovSource source) const {
  bool is_any = false;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) \
  is_any = is_any || (FIELD && AovSource::SOURCE == source);
#include "promin/kinds/aovs.def"
  return is_any;
}

bool AovSet::any() const {
  bool is_any = cryptomatte;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) is_any = is_any || FIELD;
#include "promin/kinds/aovs.def"
  return is_any;
}

AovSet AovSet::operator|(const AovSet& other) const {
  AovSet set;
  set.cryptomatte = cryptomatte || other.cryptomatte;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) set.FIELD = FIELD || other.FIELD;
#include "promin/kinds/aovs.def"
  return set;
}

void Aovs::resize(size_t pixel_count, const AovSet& set) {
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) FIELD.assign(set.FIELD ? pixel_count : 0, MISS);
#include "promin/kinds/aovs.def"
  object_coverage.assign(set.cryptomatte ? pixel_count : 0, CoverageRanks{});
  material_coverage.assign(set.cryptomatte ? pixel_count : 0, CoverageRanks{});
}

std::span<const std::string_view> aov_names() {
  static constexpr std::array kNames = {
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) std::string_view(#FIELD),
#include "promin/kinds/aovs.def"
  };
  return kNames;
}

}  // namespace promin
