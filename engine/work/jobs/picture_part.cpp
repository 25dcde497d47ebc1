// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/picture_part.h"

#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string>

#include "core/json_text.h"
#include "promin/error.h"
#include "trace/film/refinement.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json json_of(const PixelWindow& window) {
  return {window.lo.x, window.lo.y, window.hi.x, window.hi.y};
}

PixelWindow read_window(const Json& json) {
  return {uvec2(json.at(0).get<uint32_t>(), json.at(1).get<uint32_t>()),
          uvec2(json.at(2).get<uint32_t>(), json.at(3).get<uint32_t>())};
}

/// Returns an accuracy without the number of first samples, which is in the part's metadata.
Json json_of(const PictureError& error) {
  return {{"target", error.target},
          {"largest_claim", error.largest_claim},
          {"unmet_pixels", error.unmet_pixels},
          {"samples", error.samples}};
}

PictureError error_of(const Json& json) {
  return {.target = json.at("target"),
          .largest_claim = json.at("largest_claim"),
          .unmet_pixels = json.at("unmet_pixels"),
          .samples = json.at("samples")};
}

/// Returns the choice with this index. Throws std::out_of_range if there is no such choice.
template <typename Choice>
Choice choice_of(const Json& json, size_t count) {
  const auto number = json.get<int64_t>();
  if (number < 0 || static_cast<size_t>(number) >= count) throw std::out_of_range("no such choice");
  return static_cast<Choice>(number);
}

/// Returns the device and driver (driver_of) of a picture with these metadata.
std::string driver_from(const Metadata& metadata) {
  std::string driver;
  for (const auto& [name, value] : metadata) {
    if (name == "promin:device" || name == "promin:driver") driver += (driver.empty() ? "" : ", ") + value;
  }
  return driver;
}

bool is_within(const PixelWindow& part, const PixelWindow& window) {
  return glm::all(glm::lessThanEqual(window.lo, part.lo)) && glm::all(glm::lessThanEqual(part.hi, window.hi)) &&
         glm::all(glm::lessThan(part.lo, part.hi));
}

}  // namespace

jobs::Content encode_part(const PicturePart& part) {
  Json channels = Json::array();
  for (const Channel& channel : part.channels) {
    channels.push_back({{"name", channel.name}, {"is_integer", channel.is_integer}});
    if (channel.is_hidden) channels.back()["is_hidden"] = true;
  }
  Json json = {{"driver", driver_from(part.metadata)},
               {"full_size", {part.full_size.x, part.full_size.y}},
               {"window", json_of(part.window)},
               {"part", json_of(part.part)},
               {"exposure_ev", part.display.exposure_ev},
               {"tone_mapping", part.display.tone_mapping},
               {"dithers", part.display.dithers},
               {"exr", {part.exr.is_half, part.exr.compression}},
               {"channels", channels},
               {"metadata", part.metadata}};
  if (part.frame) json["frame"] = *part.frame;
  if (part.error) json["error"] = json_of(*part.error);
  jobs::Content content{json_text(json), {}};
  const auto append = [&](const auto& values) {
    const auto bytes = std::as_bytes(std::span(values));
    content.bytes.insert(content.bytes.end(), bytes.begin(), bytes.end());
  };
  append(part.image.pixels);
  for (const Channel& channel : part.channels) append(channel.values);
  return content;
}

PicturePart decode_part(const jobs::Content& content, const fs::path& file) {
  const InputError bad(
      {"job.piece.kind", "the piece is not part of a picture", file.string(), "remove it and run the job again"});
  PicturePart part;
  try {
    const Json json = read_ordered_json(content.description);
    if (json.contains("frame")) part.frame = json.at("frame").get<uint32_t>();
    part.full_size = uvec2(json.at("full_size").at(0).get<uint32_t>(), json.at("full_size").at(1).get<uint32_t>());
    part.window = read_window(json.at("window"));
    part.part = read_window(json.at("part"));
    part.display.exposure_ev = json.at("exposure_ev");
    part.display.tone_mapping = choice_of<ToneMapping>(json.at("tone_mapping"), tone_mapping_names().size());
    part.display.dithers = json.at("dithers");
    const Json& exr = json.at("exr");
    part.exr = {exr.at(0).get<bool>(), choice_of<ExrCompression>(exr.at(1), exr_compression_names().size())};
    part.metadata = json.at("metadata").get<Metadata>();
    for (const Json& channel : json.at("channels")) {
      part.channels.push_back({channel.at("name"), channel.at("is_integer"), {}, channel.contains("is_hidden")});
    }
    if (json.contains("error")) part.error = error_of(json.at("error"));
  } catch (const nlohmann::json::exception&) {
    throw bad;
  } catch (const std::out_of_range&) {
    throw bad;
  }
  if (!is_within(part.part, part.window) || glm::any(glm::greaterThan(part.window.hi, part.full_size))) throw bad;
  const size_t pixels = area_of(part.part);
  if (content.bytes.size() != pixels * (sizeof(vec3) + sizeof(uint32_t) * part.channels.size())) throw bad;
  part.image.size = size_of(part.part);
  part.image.pixels.resize(pixels);
  const std::byte* from = content.bytes.data();
  std::memcpy(part.image.pixels.data(), from, pixels * sizeof(vec3));
  from += pixels * sizeof(vec3);
  for (Channel& channel : part.channels) {
    channel.values.resize(pixels);
    std::memcpy(channel.values.data(), from, pixels * sizeof(uint32_t));
    from += pixels * sizeof(uint32_t);
  }
  return part;
}

}  // namespace promin::work
