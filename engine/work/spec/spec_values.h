// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/suggest.h"
#include "promin/math.h"
#include "promin/view.h"
#include "work/spec/render_spec.h"
#include "work/spec/value_words.h"

// Types that read and write the values of members of specifications. Each has `write`, which returns a value as JSON,
// and `read`, which throws WrongValue.
namespace promin::work::fields {

using Json = nlohmann::ordered_json;

/// Throws WrongValue for a value in place of what the member takes. `near` is a word that the user may have meant.
[[noreturn]] void refuse_value(const std::string& takes, const Json& value, std::string_view near = {});

/// Returns a number with the fewest digits that reproduce it.
Json write_number(float value);
Json write_number(double value);
Json write_number(uint32_t value);

uint32_t read_whole(const Json& json, uint32_t min, uint32_t max);
/// Reads a number in a range. The range applies to the number as stored, because the shortest digits of a float
/// represent another number in double.
template <typename Number = double>
Number read_real(const Json& json, Number min, Number max) {
  const double value = json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
  const auto stored = static_cast<Number>(value);
  // The comparison is written so that a NaN is refused.
  if (!(stored >= min && stored <= max)) refuse_value(fmt::format("a number from {:g} to {:g}", min, max), json);
  return stored;
}

/// A number in a range. The member's type determines the kind of number.
template <typename Number>
struct NumberIn {
  Number min;
  Number max;

  Json write(Number value) const { return write_number(value); }
  Number read(const Json& json) const {
    if constexpr (std::is_floating_point_v<Number>) {
      return read_real(json, min, max);
    } else {
      return read_whole(json, min, max);
    }
  }
};

struct Flag {
  Json write(bool value) const { return value; }
  bool read(const Json& json) const;
};

struct Text {
  Json write(const std::string& value) const { return value; }
  std::string read(const Json& json) const;
};

/// The name of a file. spec_json.cpp converts it to and from absolute paths.
struct Path {
  Json write(const std::filesystem::path& value) const { return value.string(); }
  std::filesystem::path read(const Json& json) const { return Text().read(json); }
};

/// One file or a list of files.
struct Paths {
  Json write(const std::vector<std::filesystem::path>& values) const;
  std::vector<std::filesystem::path> read(const Json& json) const;
};

/// One of some names. The first `hidden` names are not for users.
template <typename Enum>
struct NameOf {
  std::span<const std::string_view> names;
  size_t hidden = 0;

  Json write(Enum value) const { return std::string(names[static_cast<size_t>(value)]); }
  Enum read(const Json& json) const {
    const auto known = names.subspan(hidden);
    const auto found = json.is_string() ? std::ranges::find(known, json.get<std::string>()) : known.end();
    if (found == known.end()) {
      refuse_value(list_choices(known), json, json.is_string() ? nearest_name(json.get<std::string>(), known) : "");
    }
    return static_cast<Enum>(static_cast<size_t>(found - known.begin()) + hidden);
  }
};

struct Vector {
  Json write(const dvec3& value) const;
  dvec3 read(const Json& json) const;
};

/// A direction as three numbers, or the name of an axis.
struct Direction {
  Json write(const dvec3& value) const { return Vector().write(value); }
  dvec3 read(const Json& json) const;
};

/// A pair of whole numbers in a range.
struct Pair {
  uint32_t min;
  uint32_t max;

  Json write(const uvec2& value) const { return {value.x, value.y}; }
  uvec2 read(const Json& json) const;
};

/// Width and height, one of which may be 0, or a size in words.
struct Size {
  Json write(const uvec2& value) const { return {value.x, value.y}; }
  uvec2 read(const Json& json) const;
};

/// A time in seconds, or a time in words.
struct Seconds {
  Json write(double value) const { return write_number(value); }
  double read(const Json& json) const;
};

/// The name or number of an animation, or a list of them.
struct Animations {
  Json write(const std::vector<std::string>& value) const { return value.size() == 1 ? Json(value[0]) : Json(value); }
  std::vector<std::string> read(const Json& json) const;
};

struct Window {
  Json write(const PixelWindow& value) const { return {value.lo.x, value.lo.y, value.hi.x, value.hi.y}; }
  PixelWindow read(const Json& json) const;
};

struct Frames {
  Json write(const FrameRange& value) const { return {value.first, value.last}; }
  FrameRange read(const Json& json) const;
};

/// A rate, or the word for the frames that a path stores.
struct Fps {
  Json write(double value) const;
  double read(const Json& json) const;
};

/// A number of samples that is a power of two.
struct PowerOfTwo {
  Json write(uint32_t value) const { return value; }
  uint32_t read(const Json& json) const;
};

/// Numbers of lights. Each occurs once, and they are in ascending order.
struct Indices {
  Json write(const std::vector<uint32_t>& value) const { return value; }
  std::vector<uint32_t> read(const Json& json) const;
};

/// A background in words, a displayed colour as three numbers, or linear light as {"linear": [R, G, B]}.
struct Background {
  Json write(const BackgroundChoice& value) const;
  BackgroundChoice read(const Json& json) const;
};

/// The features of a picture's kernels: "all", or "scene" for those that the scene needs.
struct Features {
  Json write(bool has_all) const { return has_all ? "all" : "scene"; }
  bool read(const Json& json) const;
};

}  // namespace promin::work::fields
