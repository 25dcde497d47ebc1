// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "view/keys.h"

namespace promin::app {
namespace {

const ImVec4 kFailureColor(1.0F, 0.45F, 0.35F, 1.0F);
// These lengths are for an ordinary display.
constexpr float kFontSize = 13.0F;
constexpr float kMargin = 10.0F;
constexpr float kPanelWidth = 270.0F;
constexpr float kBarHeight = 4.0F;
constexpr float kRounding = 4.0F;

/// Converts such a length to this display.
float scaled(float length) {
  return length * ImGui::GetFontSize() / kFontSize;
}

template <typename... Arguments>
void show_text(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  ImGui::TextUnformatted(fmt::format(format, std::forward<Arguments>(arguments)...).c_str());
}

void show_times(const OverlayContent& content) {
  const FrameStatistics& statistics = *content.statistics;
  const double ms = statistics.frame_ms();
  show_text("{:.1f} fps, {:.1f} ms a frame", ms > 0.0 ? 1e3 / ms : 0.0, ms);
  const StageTimes& stages = statistics.stages();
  show_text("trace {:.1f} ms,\ndisplay {:.1f}, overlay {:.1f} ms", stages.trace, stages.display, stages.overlay);
  const dvec3& rays = statistics.mrays_per_s();
  show_text("Mrays/s: {:.2f} primary,\n{:.2f} shadow, {:.2f} mirror", rays.x, rays.y, rays.z);
}

void show_picture(const ProgressivePicture& picture) {
  const auto& shown = picture.shown();
  if (!shown) return show_text("no picture yet");
  const auto& size = shown->size;
  show_text("{} x {} of {} x {}", size.x, size.y, picture.full_size().x, picture.full_size().y);
  if (const auto& error = shown->error) {
    show_text("error {:.2g}, {:.3g} spp", error->target, static_cast<double>(error->samples) / size.x / size.y);
    if (error->unmet_pixels > 0) {
      show_text("but for {} pixels of at most {:.2g}", error->unmet_pixels, error->largest_claim);
    }
  } else {
    show_text("{} spp", shown->samples_per_pixel);
  }
  ImGui::ProgressBar(static_cast<float>(picture.fraction_done()), ImVec2(-1.0F, scaled(kBarHeight)), "");
}

void choose_scale(std::optional<double>& scale) {
  struct Row {
    const char* name;
    std::optional<double> scale;
  };
  static constexpr std::array kRows = {Row{"auto", std::nullopt}, Row{"1/8", 0.125}, Row{"1/4", 0.25}, Row{"1/2", 0.5},
                                       Row{"full", 1.0}};
  const auto current = std::find_if(kRows.begin(), kRows.end(), [&](const Row& row) { return row.scale == scale; });
  const std::string name = current == kRows.end() ? fmt::format("{:g}", *scale) : current->name;
  if (!ImGui::BeginCombo("resolution", name.c_str())) return;
  for (const Row& row : kRows) {
    if (ImGui::Selectable(row.name, row.scale == scale)) scale = row.scale;
  }
  ImGui::EndCombo();
}

void choose_builder(SceneChoice& choice) {
  if (choice.bvh) return show_text("tree of {}", choice.bvh->filename().string());
  if (!ImGui::BeginCombo("builder", choice.builder.c_str())) return;
  for (const std::string_view name : builder_names()) {
    if (ImGui::Selectable(std::string(name).c_str(), name == choice.builder)) choice.builder = name;
  }
  ImGui::EndCombo();
}

void choose_lights(const Scene& scene, std::vector<uint32_t>& lights_off) {
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    const std::string& name = scene.lights[i].name;
    const auto off = std::find(lights_off.begin(), lights_off.end(), i);
    bool is_on = off == lights_off.end();
    const std::string label = fmt::format("{} {}##light{}", i, name.empty() ? "light" : name, i);
    if (!ImGui::Checkbox(label.c_str(), &is_on)) continue;
    if (is_on) {
      lights_off.erase(off);
    } else {
      lights_off.insert(std::upper_bound(lights_off.begin(), lights_off.end(), i), i);
    }
  }
}

void choose_debug_view(DebugView& view) {
  const auto names = debug_view_names();
  if (!ImGui::BeginCombo("shading", std::string(names[static_cast<size_t>(view)]).c_str())) return;
  for (size_t i = 0; i < names.size(); ++i) {
    const auto candidate = static_cast<DebugView>(i);
    if (ImGui::Selectable(std::string(names[i]).c_str(), candidate == view)) view = candidate;
  }
  ImGui::EndCombo();
}

void show_switches(const Scene& scene, Switches& switches) {
  ImGui::Checkbox("shadows", &switches.has_shadows);
  ImGui::SameLine();
  ImGui::Checkbox("mirrors", &switches.has_mirrors);
  ImGui::SameLine();
  ImGui::Checkbox("pause", &switches.is_paused);
  auto depth = static_cast<int>(switches.max_depth);
  if (ImGui::SliderInt("depth", &depth, 0, 20)) switches.max_depth = static_cast<uint32_t>(std::max(0, depth));
  choose_debug_view(switches.debug_view);
  choose_scale(switches.scale);
  choose_builder(switches.scene);
  if (ImGui::TreeNode("lights")) {
    choose_lights(scene, switches.scene.lights_off);
    ImGui::TreePop();
  }
}

std::optional<Camera> choose_camera(const OverlayContent& content) {
  std::optional<Camera> picked;
  const auto show = [&](const std::vector<Camera>& cameras, const char* kind) {
    for (size_t i = 0; i < cameras.size(); ++i) {
      const std::string& name = cameras[i].name;
      const std::string label = fmt::format("{} {}##{}{}", i + 1, name.empty() ? kind : name, kind, i);
      if (ImGui::Selectable(label.c_str())) picked = cameras[i];
    }
  };
  if (!ImGui::TreeNode("cameras")) return picked;
  show(content.scene->cameras, "camera");
  show(content.bookmarks, "bookmark");
  ImGui::TreePop();
  return picked;
}

}  // namespace

void FrameStatistics::add(const FinishedFrame& frame) {
  // A frame that traces nothing has no rate.
  if (frame.units == 0.0) return;
  constexpr double kMemoryMs = 100.0;
  const double share = std::exchange(is_first_, false) ? 1.0 : 1.0 - std::exp(-frame.time_ms / kMemoryMs);
  const auto follow = [&](double& mean, double value) { mean += share * (value - mean); };
  follow(frame_ms_, frame.time_ms);
  follow(stages_.trace, frame.stages.trace);
  follow(stages_.display, frame.stages.display);
  follow(stages_.overlay, frame.stages.overlay);
  if (!(frame.stages.trace > 0.0)) return;
  const dvec3 rays(frame.rays.primary, frame.rays.shadow, frame.rays.reflection + frame.rays.refraction);
  mrays_per_s_ += share * (1e-3 / frame.stages.trace * rays - mrays_per_s_);
}

void scale_overlay(const OverlayScale& scale) {
  ImGuiIO& io = ImGui::GetIO();
  ImFontConfig font;
  font.SizePixels = kFontSize * static_cast<float>(scale.content);
  io.Fonts->Clear();
  io.Fonts->AddFontDefault(&font);
  io.FontGlobalScale = static_cast<float>(1.0 / scale.pixel_ratio);
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  ImGui::StyleColorsDark();
  style.WindowRounding = kRounding;
  style.ScaleAllSizes(static_cast<float>(scale.content / scale.pixel_ratio));
}

std::optional<Camera> show_overlay(const OverlayContent& content, Switches& switches) {
  ImGui::SetNextWindowPos(ImVec2(scaled(kMargin), scaled(kMargin)), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize(ImVec2(scaled(kPanelWidth), 0.0F));
  ImGui::SetNextWindowBgAlpha(0.75F);
  ImGui::Begin("promin  (H: help, Tab: hide)", nullptr,
               ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PushTextWrapPos();
  show_text("{}", content.device);
  show_times(content);
  show_picture(*content.picture);
  show_text("{}, speed {:.3g} a second", content.is_orbiting ? "orbiting" : "flying", content.speed);
  if (!content.awaited.empty()) show_text("{} ...", content.awaited);
  if (content.is_failure) ImGui::PushStyleColor(ImGuiCol_Text, kFailureColor);
  if (!content.message.empty()) show_text("{}", content.message);
  if (content.is_failure) ImGui::PopStyleColor();
  ImGui::Separator();
  show_switches(*content.scene, switches);
  const std::optional<Camera> picked = choose_camera(content);
  ImGui::PopTextWrapPos();
  ImGui::End();
  return picked;
}

void show_help() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(size.x - scaled(kMargin), scaled(kMargin)), ImGuiCond_FirstUseEver,
                          ImVec2(1.0F, 0.0F));
  ImGui::SetNextWindowBgAlpha(0.75F);
  ImGui::Begin("Keys", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
  for (const KeyBinding& binding : key_bindings()) {
    if (*binding.name != '\0') show_text("{:<12}{}", binding.name, binding.effect);
  }
  for (const PointerBinding& binding : pointer_bindings()) show_text("{:<12}{}", binding.name, binding.effect);
  ImGui::End();
}

bool show_explanation(const std::string& title, const std::string& text) {
  bool is_open = true;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(size.x - scaled(kMargin), size.y - scaled(kMargin)), ImGuiCond_FirstUseEver,
                          ImVec2(1.0F, 1.0F));
  ImGui::SetNextWindowSize(ImVec2(0.55F * size.x, 0.5F * size.y), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowBgAlpha(0.85F);
  ImGui::Begin((title + "###explanation").c_str(), &is_open,
               ImGuiWindowFlags_HorizontalScrollbar | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::TextUnformatted(text.c_str());
  ImGui::End();
  return is_open;
}

}  // namespace promin::app
