// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "promin/math.h"

namespace promin {

/// Reads a colour as it is written for web pages: a name of color_names(), "#rrggbb" or "#rgb", in upper or lower case.
/// Returns sRGB, 0 to 1; nullopt for other words.
std::optional<vec3> find_color(std::string_view word);

/// Returns the names of colours in lower case: the basic colours of CSS and a few more.
std::vector<std::string_view> color_names();

/// Returns the linear light of an sRGB colour, each component in 0...1.
vec3 linear_of_srgb(const vec3& color);

}  // namespace promin
