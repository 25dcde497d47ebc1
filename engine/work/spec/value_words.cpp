// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/spec/value_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "core/parse_number.h"
#include "core/suggest.h"
#include "image/color_words.h"
#include "promin/image.h"

namespace promin::work {
namespace {

constexpr std::string_view kLinear = "linear:";
/// A background of other programs, which is an option here.
constexpr std::string_view kTransparent = "transparent";
constexpr const char* kAlpha = "--alpha";

constexpr std::array<std::string_view, 6> kAxes = {"x", "y", "z", "-x", "-y", "-z"};

/// Names of sizes. Users see the first three; the others are also accepted.
constexpr std::string_view kSizeNames[] = {"hd", "fullhd", "4k", "720p", "1080p", "1440p", "2160p"};
constexpr uvec2 kNamedSizes[] = {{1280, 720},  {1920, 1080}, {3840, 2160}, {1280, 720},
                                 {1920, 1080}, {2560, 1440}, {3840, 2160}};
static_assert(std::size(kSizeNames) == std::size(kNamedSizes));
constexpr size_t kVisibleSizes = 3;

/// A word, or a part of one.
struct Part {
  std::string_view text;
  std::string_view whole;

  [[noreturn]] void refuse(const std::string& takes) const {
    const std::string place = text == whole ? "" : fmt::format(" in \"{}\"", whole);
    throw WrongValue{fmt::format("takes {}, not \"{}\"{}", takes, text, place), ""};
  }
  double real(double min, double max) const {
    const std::optional<double> value = to_number<double>(text);
    // The comparison is written so that a NaN is refused.
    if (!value || !(*value >= min && *value <= max)) refuse(fmt::format("a number from {:g} to {:g}", min, max));
    return *value;
  }
};

/// Returns a side of a picture; 0 if the part is empty.
uint32_t read_side(const Part& part) {
  if (part.text.empty()) return 0;
  const std::optional<uint32_t> side = to_number<uint32_t>(part.text);
  if (!side || *side < 1 || *side > kMaxSide) part.refuse(fmt::format("a whole number from 1 to {}", kMaxSide));
  return *side;
}

/// Reads linear light that is written with two commas.
vec3 read_linear(std::string_view word) {
  dvec3 light;
  size_t begin = kLinear.size();
  for (int i = 0; i < 3; ++i) {
    const size_t end = std::min(word.find(',', begin), word.size());
    light[i] = Part{word.substr(begin, end - begin), word}.real(0.0, kMaxBackground);
    begin = end + 1;
  }
  return vec3(light);
}

}  // namespace

BackgroundChoice read_background(std::string_view word) {
  if (word == kEnvironmentShown) return {.is_environment = true};
  if (const std::optional<vec3> color = find_color(word)) return {.color = *color};
  if (word.starts_with(kLinear) && std::ranges::count(word, ',') == 2) {
    return {.is_linear = true, .color = read_linear(word)};
  }
  std::vector<std::string_view> known = color_names();
  known.push_back(kEnvironmentShown);
  throw WrongValue{fmt::format("takes the name of a colour, #rrggbb, three numbers from 0 to 1, {}R,G,B or {}, "
                               "not \"{}\"",
                               kLinear, kEnvironmentShown, word),
                   word == kTransparent ? kAlpha : std::string(nearest_name(word, known))};
}

std::optional<dvec3> find_axis(std::string_view word) {
  const auto found = std::ranges::find(kAxes, word);
  if (found == kAxes.end()) return {};
  const auto place = static_cast<int>(found - kAxes.begin());
  dvec3 axis(0.0);
  axis[place % 3] = place < 3 ? 1.0 : -1.0;
  return axis;
}

std::span<const std::string_view> axis_names() {
  return kAxes;
}

uvec2 read_size(std::string_view word) {
  const auto* const named = std::ranges::find(kSizeNames, word);
  if (named != std::end(kSizeNames)) return kNamedSizes[named - kSizeNames];
  constexpr std::string_view kTimes = "\u00d7";
  const size_t times = word.find(kTimes);
  const size_t by = std::min(times, word.find_first_of("xX,*"));
  const std::string_view width = word.substr(0, by);
  const size_t mark = by == times ? kTimes.size() : 1;
  const std::string_view height = by == std::string_view::npos ? "" : word.substr(by + mark);
  const auto is_number = [](std::string_view side) {
    return side.find_first_not_of("0123456789+-.") == std::string_view::npos;
  };
  if (!is_number(width) || !is_number(height) || (width.empty() && height.empty())) {
    throw WrongValue{
        fmt::format("takes a size such as 640x480, a width, {}, not \"{}\"", list_choices(size_names()), word),
        std::string(nearest_name(word, size_names()))};
  }
  return {read_side({width, word}), read_side({height, word})};
}

std::span<const std::string_view> size_names() {
  return std::span(kSizeNames).first(kVisibleSizes);
}

double read_seconds(std::string_view word) {
  struct Unit {
    std::string_view name;
    double seconds;
  };
  constexpr Unit kUnits[] = {{"ms", 1e-3}, {"min", 60.0}, {"m", 60.0}, {"sec", 1.0}, {"s", 1.0}, {"h", 3600.0}};
  for (const auto& [name, seconds] : kUnits) {
    if (!word.ends_with(name)) continue;
    const Part number{word.substr(0, word.size() - name.size()), word};
    return seconds * number.real(kMinTimeLimit / seconds, kMaxTimeLimit / seconds);
  }
  return Part{word, word}.real(kMinTimeLimit, kMaxTimeLimit);
}

}  // namespace promin::work
