// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "promin/math.h"
#include "work/spec/render_spec.h"

// Values in words, which command lines and specifications share.
namespace promin::work {

/// Thrown if a value is refused.
struct WrongValue {
  /// The end of a sentence about the option or member: "takes true or false, not 1".
  std::string what;
  /// A word that the user may have meant; empty if none is known.
  std::string near;
};

/// The word for a background that shows the environment.
inline constexpr std::string_view kEnvironmentShown = "environment";

/// Reads a background: "environment", the name of a colour, "#rrggbb", or linear light as "linear:R,G,B". Throws
/// WrongValue.
BackgroundChoice read_background(std::string_view word);

/// Returns the unit vector of an axis from axis_names(); nullopt for other words.
std::optional<dvec3> find_axis(std::string_view word);
std::span<const std::string_view> axis_names();

/// Reads the size of a picture in pixels: "640x480", "640" (the width), "x480" (the height) or a name such as "hd". A
/// missing side is 0. Throws WrongValue.
uvec2 read_size(std::string_view word);
/// Returns the names of sizes that users see.
std::span<const std::string_view> size_names();

/// Reads a time limit in seconds: "20", "20s" or "2min". Throws WrongValue.
double read_seconds(std::string_view word);

}  // namespace promin::work
