// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "shared/layout.h"

namespace promin::layout {

/// A set of features FEATURE_* (promin/kinds) that a scene uses or a caller requests. Pipelines are specialised for it.
class FeatureMask {
 public:
  constexpr FeatureMask() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a feature is the set of it alone.
  constexpr FeatureMask(Feature feature) : bits_(uint64_t{1} << static_cast<uint>(feature)) {}

  /// Returns the mask of pictures with this debug view (DEBUG_VIEW_*).
  static constexpr FeatureMask of_debug_view(uint view) {
    FeatureMask mask;
    mask.bits_ = uint64_t{view & DEBUG_VIEW_MASK} << (32 + DEBUG_VIEW_SHIFT);
    return mask;
  }

  constexpr bool has_any(FeatureMask features) const { return (bits_ & features.bits_) != 0; }
  constexpr bool is_empty() const { return bits_ == 0; }
  constexpr FeatureMask without(FeatureMask features) const { return from_bits(bits_ & ~features.bits_); }
  constexpr FeatureMask common_with(FeatureMask features) const { return from_bits(bits_ & features.bits_); }
  /// Returns the values of the specialisation constants CONSTANT_FEATURES and CONSTANT_MORE_FEATURES.
  constexpr std::array<uint32_t, FEATURE_WORDS> words() const {
    return {static_cast<uint32_t>(bits_), static_cast<uint32_t>(bits_ >> 32)};
  }

  constexpr FeatureMask& operator|=(FeatureMask other) {
    bits_ |= other.bits_;
    return *this;
  }
  friend constexpr FeatureMask operator|(FeatureMask a, FeatureMask b) { return a |= b; }
  friend constexpr bool operator==(FeatureMask, FeatureMask) = default;

 private:
  static constexpr FeatureMask from_bits(uint64_t bits) {
    FeatureMask mask;
    mask.bits_ = bits;
    return mask;
  }

  uint64_t bits_ = 0;
};

constexpr FeatureMask operator|(Feature a, Feature b) {
  return FeatureMask(a) | FeatureMask(b);
}

}  // namespace promin::layout

namespace promin {
using layout::FeatureMask;
}
