// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/run_stats.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/json_text.h"
#include "image/picture_endings.h"

namespace promin::work {
namespace {

using Json = nlohmann::ordered_json;

/// Names of the metadata of pictures with an error target: the mean number of samples, and the prefix of the other
/// names.
constexpr std::string_view kSamplesEntry = "promin:spp";
constexpr std::string_view kErrorEntries = "promin:error_";

uint64_t pixel_count(const View& view) {
  const uvec2 size = view.crop ? view.crop->hi - view.crop->lo : view.size;
  return uint64_t{size.x} * size.y;
}

Json json_of_scene(const RunStats& stats) {
  Json json = {{"file", stats.scene_file}, {"objects", stats.object_count}};
  for (size_t i = 0; i < kObjectNames.size(); ++i) json[std::string(kObjectNames[i])] = stats.scene.objects[i];
  json["primitives"] = stats.scene.primitives;
  json["triangles"] = stats.scene.triangles;
  json["stored_triangles"] = stats.scene.stored_triangles;
  json["degenerate_triangles"] = stats.setup.degenerate_triangles;
  json["materials"] = stats.material_count;
  json["lights"] = stats.light_count;
  return json;
}

std::string name_of(ToneMapping mapping) {
  return std::string(tone_mapping_names()[static_cast<size_t>(mapping)]);
}

std::string name_of(PixelFilter filter) {
  return std::string(pixel_filter_names()[static_cast<size_t>(filter)]);
}

Json json_of_view(const View& view, const DisplayTransform& display) {
  Json json = {{"size", {view.size.x, view.size.y}},
               {"samples_per_pixel", view.samples_per_pixel},
               {"filter", name_of(view.filter)}};
#define PROMIN_VIEW_NUMBER(NAME, TYPE, MIN, MAX, USUAL, PLACEHOLDER, HELP) json[#NAME] = view.NAME;
#include "work/spec/view_numbers.def"
  json["integrator"] = integrator_names()[static_cast<size_t>(view.mode.integrator)];
  json["exposure_ev"] = display.exposure_ev;
  json["tone_mapping"] = name_of(display.tone_mapping);
  if (view.crop) json["crop"] = {view.crop->lo.x, view.crop->lo.y, view.crop->hi.x, view.crop->hi.y};
  return json;
}

Json json_of_bvh(const BvhStats& bvh) {
  return {{"builder", bvh.builder},  {"nodes", bvh.nodes}, {"leaves", bvh.leaves},
          {"depth", bvh.depth},      {"bytes", bvh.bytes}, {"max_leaf_size", bvh.max_leaf_size},
          {"sah_cost", bvh.sah_cost}};
}

Json json_of_error(const RunStats& stats, size_t picture) {
  const PictureError& error = stats.errors[picture];
  return {{"in", stats.view->error_target->display ? "display" : "linear"},
          {"target", error.target},
          {"largest_claim", error.largest_claim},
          {"unmet_pixels", error.unmet_pixels},
          {"mean_samples", mean_samples(*stats.view, error)}};
}

Json json_of_frames(const RunStats& stats) {
  Json json = Json::array();
  for (size_t i = 0; i < stats.trace_ms.size(); ++i) {
    json.push_back({{"frame", stats.frames[i]}, {"trace_ms", stats.trace_ms[i]}});
    if (!stats.errors.empty()) json.back()["error"] = json_of_error(stats, i);
  }
  return json;
}

}  // namespace

double RunStats::median_trace_ms() const {
  return median(trace_ms);
}

double RunStats::mrays_per_s() const {
  const double ms = frames.empty() ? median_trace_ms() : std::accumulate(trace_ms.begin(), trace_ms.end(), 0.0);
  return ms > 0.0 ? static_cast<double>(rays.total()) / (1e3 * ms) : 0.0;
}

double mean_samples(const View& view, const PictureError& error) {
  return static_cast<double>(error.samples) / static_cast<double>(pixel_count(view));
}

bool is_error_metadata(std::string_view name) {
  return name == kSamplesEntry || name.starts_with(kErrorEntries);
}

void put_error(Metadata& metadata, const PictureError& error, uint64_t pixel_count) {
  const auto put = [&](const std::string& name, const std::string& value) {
    const auto found = std::ranges::find(metadata, name, &Metadata::value_type::first);
    if (found == metadata.end()) {
      metadata.emplace_back(name, value);
    } else {
      found->second = value;
    }
  };
  const double samples = static_cast<double>(error.samples) / static_cast<double>(pixel_count);
  put(std::string(kSamplesEntry), fmt::format("{:.9g}", samples));
  const std::string entries(kErrorEntries);
  put(entries + "target", fmt::format("{}", error.target));
  put(entries + "max", fmt::format("{}", error.largest_claim));
  put(entries + "unmet", std::to_string(error.unmet_pixels));
}

Metadata describe_picture(const RunStats& stats) {
  Metadata metadata = {{std::string(kVersionEntry), PROMIN_VERSION},
                       {std::string(kSceneKey), stats.scene_file},
                       {"promin:device", stats.device.name},
                       {"promin:driver", stats.device.driver},
                       {"promin:size", fmt::format("{}x{}", stats.view->size.x, stats.view->size.y)},
                       {"promin:spp", std::to_string(stats.view->samples_per_pixel)},
                       {"promin:filter", fmt::format("{} {:g}", name_of(stats.view->filter), stats.view->filter_width)},
                       {"promin:max_depth", std::to_string(stats.view->max_depth)},
                       {"promin:exposure_ev", fmt::format("{:g}", stats.display.exposure_ev)},
                       {"promin:tone_mapping", name_of(stats.display.tone_mapping)}};
  if (stats.view->mode.integrator != Integrator::kWhitted || stats.has_named_integrator) {
    metadata.emplace_back("promin:integrator", integrator_names()[static_cast<size_t>(stats.view->mode.integrator)]);
    metadata.emplace_back("promin:seed", std::to_string(stats.view->seed));
  }
  if (stats.motion.any()) {
    metadata.emplace_back("promin:time_s", fmt::format("{}", stats.motion.time_s.value_or(0.0)));
    metadata.emplace_back("promin:animation", stats.motion.animations.empty()
                                                  ? "0"
                                                  : fmt::format("{}", fmt::join(stats.motion.animations, ", ")));
    if (stats.motion.loops) metadata.emplace_back("promin:loop", "true");
  }
  if (stats.shutter) metadata.emplace_back("promin:shutter", fmt::format("{}", *stats.shutter));
  if (stats.shutter_fps) metadata.emplace_back("promin:fps", fmt::format("{}", *stats.shutter_fps));
  const bool has_instances = std::ranges::count(stats.setup.features, std::string_view("instances")) > 0;
  if (has_instances || stats.instances != Instancing::kAuto) {
    metadata.emplace_back("promin:instances", instancing_names()[static_cast<size_t>(stats.instances)]);
  }
  if (stats.errors.empty()) return metadata;
  const ErrorTarget& target = *stats.view->error_target;
  metadata.emplace_back("promin:min_spp", std::to_string(stats.errors.back().first_samples));
  metadata.emplace_back("promin:max_spp", std::to_string(target.max_samples));
  if (target.display) metadata.emplace_back("promin:error_in", "display");
  put_error(metadata, stats.errors.back(), pixel_count(*stats.view));
  return metadata;
}

std::string to_json(const RunStats& stats) {
  Json json = {
      {"version", PROMIN_VERSION},
      {"device", stats.device.name},
      {"device_type", stats.device.type},
      {"driver", stats.device.driver},
      {"scene", json_of_scene(stats)},
      {"features", stats.setup.features},
      {"bvh", json_of_bvh(stats.setup.bvh)},
      {"device_bytes", stats.setup.device_bytes},
      {"kernels", {{"compiled", stats.kernels.compiled}, {"read", stats.kernels.read}}},
      {"times_ms",
       {{"load", stats.load_ms},
        {"bvh", stats.setup.bvh_ms},
        {"upload", stats.setup.upload_ms},
        {"pipeline", stats.setup.pipeline_ms},
        {"trace", stats.median_trace_ms()},
        {"write", stats.write_ms},
        {"total", stats.total_ms}}},
      {"rays",
       {{"primary", stats.rays.primary},
        {"shadow", stats.rays.shadow},
        {"reflection", stats.rays.reflection},
        {"refraction", stats.rays.refraction},
        {"primary_hits", stats.rays.primary_hits},
        {"pass_through", stats.rays.passed}}},
      {"mrays_per_s", stats.mrays_per_s()},
  };
  if (stats.frames.empty()) {
    json["trace_runs_ms"] = stats.trace_ms;
  } else {
    json["frames"] = json_of_frames(stats);
  }
  if (stats.frames.empty() && !stats.errors.empty()) json["error"] = json_of_error(stats, 0);
  if (stats.view) json["view"] = json_of_view(*stats.view, stats.display);
  return json_text(json, 2) + "\n";
}

}  // namespace promin::work
