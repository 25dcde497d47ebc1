// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/spec/spec_values.h"

#include <bit>
#include <optional>

#include "core/json_text.h"
#include "promin/image.h"
#include "promin/validate.h"
#include "work/pictures/camera_path.h"

namespace promin::work::fields {
namespace {

constexpr const char* kStoredFrames = "stored";
constexpr const char* kLinearLight = "linear";

template <typename Number>
Json write_shortest(Number value) {
  return read_ordered_json(fmt::format("{}", value));
}

const Json& read_array(const Json& json, size_t size, const std::string& takes) {
  if (!json.is_array() || json.size() != size) refuse_value(takes, json);
  return json;
}

Json write_color(const vec3& color) {
  return {write_number(color.x), write_number(color.y), write_number(color.z)};
}

vec3 read_color(const Json& json, double most) {
  const Json& parts = read_array(json, 3, "three numbers");
  return vec3(dvec3(read_real(parts[0], 0.0, most), read_real(parts[1], 0.0, most), read_real(parts[2], 0.0, most)));
}

}  // namespace

void refuse_value(const std::string& takes, const Json& value, std::string_view near) {
  throw WrongValue{fmt::format("takes {}, not {}", takes, json_text(value)), std::string(near)};
}

Json write_number(float value) {
  return write_shortest(value);
}

Json write_number(double value) {
  return write_shortest(value);
}

Json write_number(uint32_t value) {
  return value;
}

uint32_t read_whole(const Json& json, uint32_t min, uint32_t max) {
  const bool is_whole = json.is_number_unsigned() || (json.is_number_integer() && json.get<int64_t>() >= 0);
  if (!is_whole || json.get<uint64_t>() < min || json.get<uint64_t>() > max) {
    refuse_value(fmt::format("a whole number from {} to {}", min, max), json);
  }
  return json.get<uint32_t>();
}

bool Flag::read(const Json& json) const {
  if (!json.is_boolean()) refuse_value("true or false", json);
  return json.get<bool>();
}

std::string Text::read(const Json& json) const {
  if (!json.is_string()) refuse_value("a text", json);
  return json.get<std::string>();
}

Json Paths::write(const std::vector<std::filesystem::path>& values) const {
  Json json = Json::array();
  for (const std::filesystem::path& value : values) json.push_back(value.string());
  return json;
}

std::vector<std::filesystem::path> Paths::read(const Json& json) const {
  if (!json.is_array()) return {Path().read(json)};
  std::vector<std::filesystem::path> files;
  for (const Json& part : json) files.push_back(Path().read(part));
  return files;
}

Json Vector::write(const dvec3& value) const {
  return {write_number(value.x), write_number(value.y), write_number(value.z)};
}

dvec3 Vector::read(const Json& json) const {
  const Json& parts = read_array(json, 3, "three numbers");
  const auto part = [&](size_t i) { return read_real(parts[i], -kMaxCoordinate, kMaxCoordinate); };
  return {part(0), part(1), part(2)};
}

dvec3 Direction::read(const Json& json) const {
  if (!json.is_string()) return Vector().read(json);
  const std::optional<dvec3> axis = find_axis(json.get<std::string>());
  if (!axis) refuse_value(fmt::format("three numbers, {}", list_choices(axis_names())), json);
  return *axis;
}

uvec2 Pair::read(const Json& json) const {
  const Json& parts = read_array(json, 2, "two whole numbers");
  return {read_whole(parts[0], min, max), read_whole(parts[1], min, max)};
}

uvec2 Size::read(const Json& json) const {
  if (json.is_string()) return read_size(json.get<std::string>());
  const uvec2 size = Pair{0, kMaxSide}.read(json);
  if (size == uvec2(0)) refuse_value("a width and a height, one of which may be 0 for the camera's choice", json);
  return size;
}

double Seconds::read(const Json& json) const {
  if (json.is_string()) return read_seconds(json.get<std::string>());
  return read_real(json, kMinTimeLimit, kMaxTimeLimit);
}

std::vector<std::string> Animations::read(const Json& json) const {
  const auto read_one = [](const Json& one) {
    if (one.is_number_unsigned()) return std::to_string(one.get<uint64_t>());
    if (!one.is_string() || one.get<std::string>().empty()) refuse_value("the name or number of an animation", one);
    return one.get<std::string>();
  };
  if (!json.is_array()) return {read_one(json)};
  std::vector<std::string> words;
  for (const Json& part : json) words.push_back(read_one(part));
  return words;
}

PixelWindow Window::read(const Json& json) const {
  const std::string takes = "X0, Y0, X1, Y1 with X0 < X1 and Y0 < Y1";
  const Json& parts = read_array(json, 4, takes);
  const auto part = [&](size_t i) { return read_whole(parts[i], 0, kMaxSide); };
  const PixelWindow window = {{part(0), part(1)}, {part(2), part(3)}};
  if (window.lo.x >= window.hi.x || window.lo.y >= window.hi.y) refuse_value(takes, json);
  return window;
}

FrameRange Frames::read(const Json& json) const {
  const uvec2 ends = Pair{0, kMaxFrame}.read(json);
  if (ends.x > ends.y) refuse_value("the first frame and the last", json);
  return {ends.x, ends.y};
}

Json Fps::write(double value) const {
  return value == PathPictures::kStored ? Json(kStoredFrames) : write_number(value);
}

double Fps::read(const Json& json) const {
  if (json == kStoredFrames) return PathPictures::kStored;
  return read_real(json, PathPictures::kMinFps, PathPictures::kMaxFps);
}

uint32_t PowerOfTwo::read(const Json& json) const {
  const uint32_t samples = read_whole(json, kMinRefinedSamples, kMaxRefinedSamples);
  if (!std::has_single_bit(samples)) refuse_value("a power of two", json);
  return samples;
}

std::vector<uint32_t> Indices::read(const Json& json) const {
  if (!json.is_array()) refuse_value("numbers of 0 or more", json);
  std::vector<uint32_t> numbers;
  for (const Json& part : json) numbers.push_back(read_whole(part, 0, std::numeric_limits<uint32_t>::max()));
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

Json Background::write(const BackgroundChoice& value) const {
  if (value.is_environment) return std::string(kEnvironmentShown);
  return value.is_linear ? Json{{kLinearLight, write_color(value.color)}} : write_color(value.color);
}

BackgroundChoice Background::read(const Json& json) const {
  if (json.is_string()) return read_background(json.get<std::string>());
  if (json.is_object() && json.size() == 1 && json.contains(kLinearLight)) {
    return {.is_linear = true, .color = read_color(json[kLinearLight], kMaxBackground)};
  }
  return {.color = read_color(json, 1.0)};
}

bool Features::read(const Json& json) const {
  if (json != "all" && json != "scene") refuse_value("scene or all", json);
  return json == "all";
}

}  // namespace promin::work::fields
