// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/panel/overlay.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <utility>

#include "output/font.h"
#include "view/display/imgui_renderer.h"
#include "view/keys.h"

namespace promin::app {
namespace {

const ImVec4 kFailureColor(1.0F, 0.45F, 0.35F, 1.0F);
// Lengths in pixels, for a display that does not scale.
constexpr float kFontSize = 14.0F;
constexpr float kMargin = 10.0F;
constexpr float kPanelWidth = 290.0F;
constexpr float kFieldWidth = 160.0F;
constexpr float kSpeedWidth = 100.0F;
constexpr float kEffectColumn = 100.0F;
constexpr float kBarHeight = 4.0F;
constexpr float kRounding = 4.0F;

/// Converts a length to pixels of this display.
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
  show_text("{}", content.device);
  show_text("{:.1f} pictures per second, {:.1f} ms each", ms > 0.0 ? 1e3 / ms : 0.0, ms);
  const StageTimes& stages = statistics.stages();
  show_text("trace {:.1f} ms, display {:.1f} ms", stages.trace, stages.display);
  const dvec3& rays = statistics.mrays_per_s();
  show_text("Mrays/s: {:.2f} primary, {:.2f} shadow, {:.2f} mirror", rays.x, rays.y, rays.z);
  const auto& shown = content.picture->shown();
  if (!shown) return;
  show_text("{} x {} of {} x {} pixels", shown->size.x, shown->size.y, content.picture->full_size().x,
            content.picture->full_size().y);
  if (!shown->error) show_text("samples per pixel: {}", shown->samples_per_pixel);
}

/// Returns an error as a word.
std::string describe_error(float error) {
  return error > 0.0F && error < 1.0F ? fmt::format("1/{:.0f}", 1.0 / static_cast<double>(error))
                                      : fmt::format("{:.2g}", error);
}

/// Returns a description of the picture's quality.
std::string describe_quality(const ProgressivePicture& picture) {
  const auto& shown = picture.shown();
  if (!shown) return "making the first picture";
  if (shown->size != picture.full_size()) return "coarse so far";
  if (!shown->error) return picture.is_settled() ? "done" : "sharpening";
  return describe_accuracy(*shown, picture.is_settled());
}

void show_state(const OverlayContent& content) {
  if (!content.awaited.empty()) {
    show_text("{} ...", content.awaited);
  } else if (content.picture != nullptr) {
    show_text("{}", describe_quality(*content.picture));
  }
  // Work that is awaited has no known fraction.
  const bool has_share = content.picture != nullptr && content.awaited.empty();
  const double done = has_share ? content.picture->fraction_done() : 0.0;
  ImGui::ProgressBar(static_cast<float>(done), ImVec2(-1.0F, scaled(kBarHeight)), "");
}

void show_message(const OverlayContent& content) {
  if (content.is_failure) ImGui::PushStyleColor(ImGuiCol_Text, kFailureColor);
  if (!content.message.empty()) show_text("{}", content.message);
  if (content.is_failure) ImGui::PopStyleColor();
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

/// Shows a list from which one of an enumeration's values is chosen.
template <typename Kind>
void choose_kind(const char* label, std::span<const std::string_view> names, Kind& kind) {
  if (!ImGui::BeginCombo(label, std::string(names[static_cast<size_t>(kind)]).c_str())) return;
  for (size_t i = 0; i < names.size(); ++i) {
    const auto candidate = static_cast<Kind>(i);
    if (ImGui::Selectable(std::string(names[i]).c_str(), candidate == kind)) kind = candidate;
  }
  ImGui::EndCombo();
}

void choose_exposure(const OverlayContent& content, std::optional<float>& exposure_ev) {
  constexpr float kMostEv = 6.0F;
  float ev = exposure_ev.value_or(content.exposure_ev);
  if (ImGui::SliderFloat("exposure", &ev, -kMostEv, kMostEv, "%+.1f EV")) exposure_ev = ev;
}

void choose_background(const OverlayContent& content, std::optional<vec3>& background) {
  vec3 color = background.value_or(content.background);
  constexpr ImGuiColorEditFlags kSwatch = ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel;
  if (ImGui::ColorEdit3("##color of the background", &color.x, kSwatch)) background = color;
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  ImGui::SameLine(0.0F, gap);
  ImGui::SetNextItemWidth(scaled(kFieldWidth) - ImGui::GetFrameHeight() - gap);
  const float brightest = std::max({color.x, color.y, color.z});
  float wanted = brightest;
  if (!ImGui::SliderFloat("background", &wanted, 0.0F, 1.0F, "%.2f")) return;
  wanted = std::clamp(wanted, 0.0F, 1.0F);
  background = brightest > 0.0F ? wanted / brightest * color : vec3(wanted);
}

void show_switches(const OverlayContent& content, Switches& switches) {
  ImGui::Checkbox("shadows", &switches.has_shadows);
  ImGui::SameLine();
  ImGui::Checkbox("mirrors", &switches.has_mirrors);
  ImGui::SameLine();
  ImGui::Checkbox("pause", &switches.is_paused);
  choose_kind("integrator", integrator_names(), switches.integrator);
  auto depth = static_cast<int>(switches.max_depth);
  if (ImGui::SliderInt("mirrors in mirrors", &depth, 0, 20)) {
    switches.max_depth = static_cast<uint32_t>(std::max(0, depth));
  }
  choose_kind("shading", debug_view_names(), switches.debug_view);
  choose_exposure(content, switches.exposure_ev);
  choose_background(content, switches.surroundings.background);
  if (ImGui::TreeNode("lights")) {
    choose_lights(*content.scene, switches.scene.lights_off);
    ImGui::TreePop();
  }
}

void choose_clip(AnimationClock& clock) {
  constexpr const char* kNoClip = "none";
  const std::vector<AnimationClock::Clip>& clips = clock.clips();
  const std::string current = clock.clip() < 0 ? kNoClip : clips[static_cast<size_t>(clock.clip())].name;
  if (!ImGui::BeginCombo("animation", current.c_str())) return;
  if (ImGui::Selectable(kNoClip, clock.clip() < 0)) clock.choose(-1);
  for (int i = 0; i < static_cast<int>(clips.size()); ++i) {
    const std::string label = fmt::format("{}##{}", clips[static_cast<size_t>(i)].name, i);
    if (ImGui::Selectable(label.c_str(), i == clock.clip())) clock.choose(i);
  }
  ImGui::EndCombo();
}

void show_clock(AnimationClock& clock) {
  if (clock.clips().empty()) return;
  choose_clip(clock);
  auto time_s = static_cast<float>(clock.time_s());
  const auto duration_s = static_cast<float>(clock.duration_s());
  if (ImGui::SliderFloat("time", &time_s, 0.0F, duration_s, "%.2f s") && duration_s > 0.0F) {
    clock.seek(static_cast<double>(time_s));
  }
  if (ImGui::Button(clock.is_playing() ? "Stop" : "Play")) clock.toggle();
  ImGui::SameLine();
  ImGui::SetNextItemWidth(scaled(kSpeedWidth));
  auto speed = static_cast<float>(clock.speed());
  if (ImGui::SliderFloat("##speed of the animation", &speed, static_cast<float>(AnimationClock::kMinSpeed),
                         static_cast<float>(AnimationClock::kMaxSpeed), "speed %.3g", ImGuiSliderFlags_Logarithmic)) {
    clock.set_speed(static_cast<double>(speed));
  }
  ImGui::Separator();
}

void show_details(const OverlayContent& content, Switches& switches, OverlayAnswer& answer) {
  if (!ImGui::TreeNode("details")) return;
  choose_scale(switches.scale);
  choose_builder(switches.scene);
  auto speed = static_cast<float>(content.speed);
  if (ImGui::DragFloat("speed", &speed, 0.02F * speed, 0.0F, 0.0F, "%.3g per second")) answer.speed = speed;
  if (content.picture != nullptr) show_times(content);
  ImGui::TreePop();
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

void show_files(const OverlayContent& content, OverlayAnswer& answer) {
  if (ImGui::Button("Open ...")) answer.asked = FileUse::kOpen;
  ImGui::SameLine();
  ImGui::BeginDisabled(content.scene == nullptr);
  if (ImGui::Button("Save ...")) answer.asked = FileUse::kSave;
  ImGui::EndDisabled();
  if (content.entry == nullptr) return;
  const char* label = content.entry->use == FileUse::kOpen ? "open" : "save as";
  if (std::exchange(content.entry->is_new, false)) ImGui::SetKeyboardFocusHere();
  answer.has_typed = ImGui::InputTextWithHint(label, "a path, then Enter", content.entry->text.data(),
                                              content.entry->text.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  answer.gives_up = !answer.has_typed && ImGui::IsItemDeactivated() && is_escape_pressed();
}

/// Calls `use` with the names of keys and pointer actions, and with their effects.
template <typename Use>
void for_each_help(const Use& use) {
  for (const PointerBinding& binding : pointer_bindings()) use(binding.name, binding.effect);
  for (const KeyBinding& binding : key_bindings()) {
    if (*binding.name != '\0') use(binding.name, binding.effect);
  }
}

}  // namespace

std::string describe_accuracy(const ShownPicture& shown, bool is_settled) {
  const double pixels = static_cast<double>(shown.size.x) * shown.size.y;
  // The percentage is rounded down, so 100 % are all pixels.
  const double percent = std::floor(1000.0 * static_cast<double>(shown.finished_pixels) / pixels) / 10.0;
  return fmt::format("{}: {:g} % of pixels within {}\n{:.3g} samples per pixel, largest error {}",
                     is_settled ? "done" : "sharpening", percent, describe_error(shown.wanted_error),
                     static_cast<double>(shown.error->samples) / pixels, describe_error(shown.error->largest_claim));
}

float overlay_margin() {
  return scaled(kMargin);
}

void FrameStatistics::add(const FinishedFrame& frame) {
  // A frame that traces nothing has no rate.
  if (frame.units == 0.0) return;
  constexpr double kMemoryMs = 100.0;
  const double share = std::exchange(is_first_, false) ? 1.0 : 1.0 - std::exp(-frame.time_ms / kMemoryMs);
  const auto follow = [&](double& mean, double value) { mean += share * (value - mean); };
  follow(frame_ms_, frame.time_ms);
  follow(stages_.trace, frame.stages.trace);
  follow(stages_.display, frame.stages.display);
  if (!(frame.stages.trace > 0.0)) return;
  const dvec3 rays(frame.rays.primary, frame.rays.shadow, frame.rays.reflection + frame.rays.refraction);
  mrays_per_s_ += share * (1e-3 / frame.stages.trace * rays - mrays_per_s_);
}

void scale_overlay(const OverlayScale& scale) {
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  const float size = kFontSize * static_cast<float>(scale.content);
  const std::optional<std::filesystem::path> font = find_font();
  if (!font || io.Fonts->AddFontFromFileTTF(font->c_str(), size) == nullptr) {
    ImFontConfig config;
    config.SizePixels = size;
    io.Fonts->AddFontDefault(&config);
  }
  io.FontGlobalScale = static_cast<float>(1.0 / scale.pixel_ratio);
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  ImGui::StyleColorsDark();
  style.WindowRounding = kRounding;
  style.FrameRounding = kRounding;
  style.ScaleAllSizes(static_cast<float>(scale.content / scale.pixel_ratio));
}

OverlayAnswer show_overlay(const OverlayContent& content, Switches& switches) {
  OverlayAnswer answer;
  ImGui::SetNextWindowPos(ImVec2(overlay_margin(), overlay_margin()), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize(ImVec2(scaled(kPanelWidth), 0.0F));
  ImGui::SetNextWindowBgAlpha(0.75F);
  ImGui::Begin("promin  (H: help, Tab: hide)", nullptr,
               ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PushTextWrapPos();
  ImGui::PushItemWidth(scaled(kFieldWidth));
  show_state(content);
  show_files(content, answer);
  show_message(content);
  if (content.scene != nullptr) {
    ImGui::Separator();
    if (content.clock != nullptr) show_clock(*content.clock);
    show_switches(content, switches);
    answer.camera = choose_camera(content);
    show_details(content, switches, answer);
  }
  ImGui::PopItemWidth();
  ImGui::PopTextWrapPos();
  answer.height = ImGui::GetCursorPosY();
  const auto share = [](const ImVec2& place) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    return dvec2(place.x / window.x, place.y / window.y);
  };
  answer.area.lo = share(ImGui::GetWindowPos());
  answer.area.hi = answer.area.lo + share(ImGui::GetWindowSize());
  ImGui::End();
  return answer;
}

void show_help() {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(size.x - overlay_margin(), overlay_margin()), ImGuiCond_Appearing, ImVec2(1.0F, 0.0F));
  ImGui::SetNextWindowSizeConstraints(ImVec2(), ImVec2(size.x, std::max(0.0F, size.y - 2.0F * overlay_margin())));
  ImGui::SetNextWindowBgAlpha(0.75F);
  ImGui::Begin("Keys", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
  for_each_help([](const char* name, const char* effect) {
    ImGui::TextUnformatted(name);
    ImGui::SameLine(scaled(kEffectColumn));
    ImGui::TextUnformatted(effect);
  });
  ImGui::End();
}

bool has_room_beside_help() {
  float text = 0.0F;
  for_each_help(
      [&](const char* /*name*/, const char* effect) { text = std::max(text, ImGui::CalcTextSize(effect).x); });
  const ImGuiStyle& style = ImGui::GetStyle();
  const float help = scaled(kEffectColumn) + text + style.WindowPadding.x + style.ScrollbarSize;
  return scaled(kPanelWidth) + help + 3.0F * overlay_margin() <= ImGui::GetIO().DisplaySize.x;
}

}  // namespace promin::app
