// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "promin/math.h"

namespace promin {

/// Reads a colour as web pages name it: a name of color_names(), "#rrggbb" or "#rgb", upper or lower case. Returns
/// sRGB, 0 to 1, and nothing for other words.
std::optional<vec3> find_color(std::string_view word);

/// The names of colours, in lower case: the basic ones of CSS and a few more.
std::vector<std::string_view> color_names();

/// The linear light of an sRGB colour, each component in 0...1.
vec3 linear_of_srgb(const vec3& color);

}  // namespace promin
