// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Names of the tables of promin/kinds that C++ lists.
#include <array>

#include "promin/aovs.h"
#include "promin/debug_view.h"
#include "promin/view.h"

namespace promin {

std::span<const std::string_view> debug_view_names() {
  static constexpr std::array kNames = {
      std::string_view("full"),
#define PROMIN_DEBUG_VIEW(KIND, ENUMERATOR, PREFIX, NUMBER, NAME, REQUEST, HELP) std::string_view(NAME),
#include "promin/kinds/debug_views.def"
  };
  return kNames;
}

#define PROMIN_DEBUG_VIEW(KIND, ENUMERATOR, PREFIX, NUMBER, NAME, REQUEST, HELP) +1
static_assert(0
#include "promin/kinds/debug_views.def"
                  < 256,
              "the number of a debug view has 8 bits");

std::span<const std::string_view> pixel_filter_names() {
  static constexpr std::array kNames = {
#define PROMIN_PIXEL_FILTER(ENUMERATOR, NAME, WIDTH) std::string_view(NAME),
#include "promin/kinds/pixel_filters.def"
  };
  return kNames;
}

std::span<const std::string_view> depth_kind_names() {
  static constexpr std::array kNames = {std::string_view("ray"), std::string_view("plane")};
  return kNames;
}

std::span<const std::string_view> integrator_names() {
  static constexpr std::array kNames = {std::string_view("whitted"), std::string_view("direct"),
                                        std::string_view("path")};
  return kNames;
}

float default_width(PixelFilter filter) {
  static constexpr std::array kWidths = {
#define PROMIN_PIXEL_FILTER(ENUMERATOR, NAME, WIDTH) static_cast<float>(WIDTH),
#include "promin/kinds/pixel_filters.def"
  };
  return kWidths.at(static_cast<size_t>(filter));
}

}  // namespace promin
