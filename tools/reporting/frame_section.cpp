// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Whole pictures: what each knob takes and brings, and the three errors apart.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "device_scene/pack_scene.h"
#include "measure/samples.h"
#include "oracle/picture.h"
#include "render/renderer_impl.h"
#include "reporting/picture.h"
#include "reporting/scene_hash.h"
#include "reporting/session.h"

namespace promin::report {
namespace {

namespace fs = std::filesystem;

/// Bounces that stand for all: what is beyond is weaker than the last bit of an ordinary mirror's picture.
constexpr uint32_t kDeep = 64;

/// Many beside those of the settings.
uint32_t truth_samples(const Session& session) {
  return session.pick(256U, 64U);
}

struct Setting {
  std::string knob;
  std::string setting;
  View view;
  std::string method = "promin";
  std::string builder = "sah";
  bool is_default = false;
};

std::vector<Setting> list_settings(const Session& session, const View& view) {
  std::vector<Setting> settings = {{"default", "default", view, "promin", "sah", true}};
  const auto add = [&](const std::string& knob, const std::string& setting) -> Setting& {
    return settings.emplace_back(Setting{knob, setting, view});
  };
  for (const uint32_t samples : session.pick<std::vector<uint32_t>>({2, 4, 8, 16}, {4})) {
    add("samples", std::to_string(samples)).view.samples_per_pixel = samples;
  }
  for (const float error : session.pick<std::vector<float>>({1.0F / 8, 1.0F / 16, 1.0F / 32, 1.0F / 64}, {1.0F / 16})) {
    add("error", fmt::format("1/{:g}", 1.0F / error)).view.error_target = ErrorTarget{.error = error};
  }
  for (const uint32_t depth : session.pick<std::vector<uint32_t>>({0, 1, 2, 3, 8, 16}, {0, 8})) {
    add("depth", std::to_string(depth)).view.max_depth = depth;
  }
  for (const auto& [name, of_size] : {std::pair("1/4", 0.25), std::pair("1/2", 0.5), std::pair("2", 2.0)}) {
    add("resolution", name).view.size = uvec2(dvec2(view.size) * of_size);
  }
  for (const char* builder : {"median", "spatial"}) add("builder", builder).builder = builder;
  add("boxes", "full").method = "full boxes";
  for (const char* method : {"fixed offset", "integer offset"}) add("offset rule", method).method = method;
  add("methods", "textbook").method = "textbook";
  return settings;
}

/// Distances and ids as the device shows them against the host's oracle, and colours; at the same samples.
Json compare_with_oracle(const oracle::Picture& expected, const RenderResult& result) {
  uint64_t other_ids = 0;
  double sum = 0.0;
  double sum2 = 0.0;
  uint64_t non_finite = 0;
  uint64_t finite = 0;
  for (size_t i = 0; i < expected.pixels.size(); ++i) {
    const oracle::Pixel& pixel = expected.pixels[i];
    const bool is_same = static_cast<int32_t>(result.aovs.object[i]) == pixel.hit.object &&
                         static_cast<int32_t>(result.aovs.primitive[i]) == pixel.hit.primitive;
    other_ids += is_same ? 0 : 1;
    const dvec3 difference = dvec3(result.image.pixels[i]) - dvec3(pixel.color);
    if (!std::isfinite(glm::dot(difference, difference))) {
      ++non_finite;
      continue;
    }
    ++finite;
    sum += std::abs(difference.x) + std::abs(difference.y) + std::abs(difference.z);
    sum2 += glm::dot(difference, difference);
  }
  const double channels = 3.0 * static_cast<double>(std::max<uint64_t>(1, finite));
  return {{"rmse", std::sqrt(sum2 / channels)},
          {"mean_absolute", sum / channels},
          {"id_mismatches", other_ids},
          {"non_finite_pixels", non_finite},
          {"pixels", expected.pixels.size()}};
}

/// Brute force takes primitives times rays: smaller pictures of larger scenes.
uvec2 oracle_size(const Session& session, const world::Scene& scene) {
  uint64_t count = 0;
  for (const world::Object& object : scene.objects) count += primitive_count(object.shape);
  if (count > 10000) return session.pick(uvec2(32, 18), uvec2(16, 9));
  if (count > 1000) return session.pick(uvec2(64, 36), uvec2(32, 18));
  return session.pick(uvec2(320, 180), uvec2(96, 54));
}

class FrameBench {
 public:
  FrameBench(const Session& session, const world::Scene& scene)
      : session_(session), scene_(scene), name_(session.name_of(scene)), hash_(hash_of(scene)) {}

  void run(Json& rows, Json& errors) {
    session_.say("frames: " + name_);
    measure_knobs(rows);
    measure_precision(errors);
    measure_other_errors(errors);
  }

 private:
  Renderer& renderer_of(const std::string& method, const std::string& builder) {
    const auto key = std::pair(method, builder);
    const auto found = renderers_.find(key);
    if (found != renderers_.end()) return found->second;
    return renderers_
        .try_emplace(key, make_renderer(session_.device(), scene_, options_for(picture_method(method), builder)))
        .first->second;
  }

  /// Of each builder.
  std::map<std::string, Json> time_builds() const {
    const std::vector<std::string> builders = {"sah", "median", "spatial"};
    std::vector<std::function<double()>> contestants;
    for (const std::string& builder : builders) {
      contestants.emplace_back([&] { return pack_scene(scene_, builder).bvh_ms; });
    }
    const std::vector<std::vector<double>> times = measure::time_in_turns(contestants, session_.few_runs());
    std::map<std::string, Json> build_ms;
    for (size_t i = 0; i < builders.size(); ++i) build_ms[builders[i]] = json_of_few(times[i]);
    return build_ms;
  }

  void measure_knobs(Json& rows) {
    const View view = view_of(scene_, session_.pick(uvec2(256, 144), uvec2(128, 72)));
    const std::vector<Setting> settings = list_settings(session_, view);
    View best = view;
    best.samples_per_pixel = truth_samples(session_);
    best.max_depth = kDeep;
    truth_ = renderer_of(settings[0].method, settings[0].builder).render(best).image;
    default_view_ = view;
    std::map<std::string, Json> build_ms = time_builds();

    std::vector<Image> images(settings.size());
    std::vector<std::function<double()>> contestants;
    for (size_t i = 0; i < settings.size(); ++i) {
      Renderer& renderer = renderer_of(settings[i].method, settings[i].builder);
      contestants.emplace_back([&, i] {
        RenderResult result = renderer.render(settings[i].view);
        images[i] = std::move(result.image);
        return result.trace_ms;
      });
    }
    const std::vector<std::vector<double>> times = measure::time_in_turns(contestants, session_.runs());
    for (Image& image : images) {
      if (image.size.x < view.size.x) image = enlarge(image, view.size);
      if (image.size.x > view.size.x) image = reduce(image, view.size);
    }
    write_pictures(images, rows.size());
    for (size_t i = 0; i < settings.size(); ++i) {
      const Setting& s = settings[i];
      Json row = {{"id", fmt::format("{}/{}/{}", name_, s.knob, s.setting)},
                  {"scene", name_},
                  {"scene_hash", hash_},
                  {"knob", s.knob},
                  {"setting", s.setting},
                  {"method", s.method},
                  {"builder", s.builder},
                  {"is_default", s.is_default},
                  {"width", s.view.size.x},
                  {"height", s.view.size.y},
                  {"ms", times[i]},
                  {"time_ratio", measure::ratios_of(times[i], times[0])},
                  {"rmse", rmse_of(images[i], truth_)},
                  {"build_ms", build_ms[s.builder]},
                  {"device_bytes", renderer_of(s.method, s.builder).setup_stats().device_bytes}};
      rows.push_back(std::move(row));
    }
  }

  /// Where they are wanted: each as N.exr by the number of its row, and what is true of them as N.truth.exr by that of
  /// the first.
  void write_pictures(const std::vector<Image>& images, size_t first_row) const {
    const std::optional<fs::path>& folder = session_.options().pictures;
    if (!folder) return;
    write_image(*folder / fmt::format("{}.truth.exr", first_row), truth_);
    for (size_t i = 0; i < images.size(); ++i) write_image(*folder / fmt::format("{}.exr", first_row + i), images[i]);
  }

  /// Precision: the same samples, by the host's oracle.
  void measure_precision(Json& errors) {
    View view = view_of(scene_, oracle_size(session_, scene_));
    const oracle::Picture expected = oracle::render(scene_, view);
    for (const PictureMethod& method : picture_methods()) {
      TunedRendererOptions options = options_for(method);
      options.with_aovs = true;
      Json row = compare_with_oracle(expected, make_renderer(session_.device(), scene_, options).render(view));
      add_error(errors, "precision", method.name, view.size, row);
      errors.back()["what"] = method.what;
    }
  }

  /// Sampling: many samples at the same depth; truncation: the same samples with deep reflection.
  void measure_other_errors(Json& errors) {
    Renderer& renderer = renderer_of("promin", "sah");
    const Image shipped = renderer.render(default_view_).image;
    View many = default_view_;
    many.samples_per_pixel = truth_samples(session_);
    add_error(errors, "sampling", "promin", many.size, {{"rmse", rmse_of(shipped, renderer.render(many).image)}});
    View deep = default_view_;
    deep.max_depth = kDeep;
    add_error(errors, "truncation", "promin", deep.size, {{"rmse", rmse_of(shipped, renderer.render(deep).image)}});
    add_error(errors, "all", "promin", deep.size, {{"rmse", rmse_of(shipped, truth_)}});
  }

  void add_error(Json& errors, const std::string& error, const std::string& method, const uvec2& size,
                 const Json& figures) const {
    Json row = {{"id", fmt::format("{}/{}/{}", name_, error, method)},
                {"scene", name_},
                {"scene_hash", hash_},
                {"error", error},
                {"method", method},
                {"width", size.x},
                {"height", size.y}};
    row.update(figures);
    errors.push_back(std::move(row));
  }

  const Session& session_;
  const world::Scene& scene_;
  std::string name_;
  std::string hash_;
  std::map<std::pair<std::string, std::string>, Renderer> renderers_;
  View default_view_;
  Image truth_;
};

}  // namespace

Json measure_frames(const Session& session) {
  Json rows = Json::array();
  Json errors = Json::array();
  const auto scenes = session.load_scenes(session.pick<std::vector<std::string>>(
      {"all_primitives.gltf", "mirrors.gltf", "showcase.gltf"}, {"mirrors.gltf"}));
  for (const world::Scene& scene : scenes) FrameBench(session, scene).run(rows, errors);
  return {{"truth_samples", truth_samples(session)},
          {"truth_depth", kDeep},
          {"rows", rows},
          {"errors", errors},
          {"gaps", Json::array()}};
}

}  // namespace promin::report
