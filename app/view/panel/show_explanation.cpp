// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/panel/show_explanation.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "view/panel/overlay.h"
#include "work/pictures/camera.h"

namespace promin::app {
namespace {

/// The largest fraction of the window's width that the panel uses.
constexpr double kPanelShare = 0.4;
constexpr ImU32 kPixelColor = IM_COL32(255, 255, 255, 220);
/// Rays whose weight is below this fraction are collapsed at first.
constexpr float kLeastOpenWeight = 0.05F;
/// Length at which a ray that hits nothing is drawn, relative to the camera ray.
constexpr float kMissShare = 0.5F;

dvec2 to_glm(const ImVec2& v) {
  return {v.x, v.y};
}

ImVec2 to_imgui(const dvec2& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y)};
}

ImVec4 to_imgui(const vec3& linear, const DisplayTransform& display) {
  const vec3 shown = apply(display, linear);
  return {encode_srgb(shown.x), encode_srgb(shown.y), encode_srgb(shown.z), 1.0F};
}

std::string name_or(const std::string& name, const std::string& kind, uint32_t number) {
  return name.empty() ? fmt::format("{} {}", kind, number) : name;
}

class ExplanationTree {
 public:
  ExplanationTree(const ExplainedPixel& explained, const DisplayTransform& display)
      : explained_(explained), scene_(*explained.scene), display_(display) {}

  void show() const {
    show_row("the pixel's color", explained_.explanation.color);
    for (const ExplainedSample& sample : explained_.explanation.samples) show_ray(sample, 0);
  }

 private:
  /// Shows a line with a swatch of its colour.
  void show_row(const std::string& text, const vec3& color) const {
    ImGui::PushID(&color);
    const float side = ImGui::GetTextLineHeight();
    ImGui::ColorButton("##color", to_imgui(color, display_), ImGuiColorEditFlags_NoTooltip, ImVec2(side, side));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%g %g %g", color.x, color.y, color.z);
    ImGui::PopID();
    ImGui::SameLine();
    ImGui::TextUnformatted(text.c_str());
  }

  static float weight_of(const ExplainedRay& ray) { return std::max({ray.weight.x, ray.weight.y, ray.weight.z}); }

  std::string describe(const ExplainedRay& ray) const {
    static constexpr std::array kNames = {"the camera sees", "mirrored:", "refracted:", "behind it:"};
    std::string text = kNames[static_cast<size_t>(ray.kind)];
    if (ray.kind != RayKind::kCamera) text += fmt::format(" {:.3g} % of", 100.0F * weight_of(ray));
    if (ray.hit.object < 0) return text + " the background";
    const auto object = static_cast<uint32_t>(ray.hit.object);
    const std::string name = name_or(scene_.objects[object].name, "object", object);
    const std::string material = name_or(scene_.materials[ray.material].name, "material", ray.material);
    return text + " " + name + (material == name ? "" : ", " + material);
  }

  std::string name_of(const ExplainedSource& source) const {
    if (source.light == ExplainedSource::kSky) return "the environment";
    if (source.light == ExplainedSource::kSurfaces) return "an emissive surface";
    if (source.light == ExplainedSource::kChosen) return "the chosen source";
    return name_or(scene_.lights[source.light].name, "light", source.light);
  }

  void show_source(const ExplainedSource& source) const {
    const std::string name = name_of(source);
    if (source.is_visible()) return show_row(name, source.contribution);
    if (!source.shadow_ray) return show_row(name + " does not reach it", source.contribution);
    const auto blocker = static_cast<uint32_t>(std::max(source.blocker.object, 0));
    show_row(fmt::format("{} is behind {}", name, name_or(scene_.objects[blocker].name, "object", blocker)),
             source.contribution);
  }

  void show_ray(const ExplainedSample& sample, uint32_t index) const {
    const ExplainedRay& ray = sample.rays[index];
    ImGui::PushID(static_cast<int>(index));
    const bool opens = weight_of(ray) >= kLeastOpenWeight;
    const bool is_open = ImGui::TreeNodeEx("ray", opens ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None,
                                           "%s", describe(ray).c_str());
    if (is_open) {
      show_row(ray.hit.object < 0 ? "its light" : "surroundings and own light", ray.own);
      for (const ExplainedSource& source : ray.sources) show_source(source);
      for (uint32_t i = index + 1; i < sample.rays.size(); ++i) {
        if (sample.rays[i].parent == index) show_ray(sample, i);
      }
      ImGui::TreePop();
    }
    ImGui::PopID();
  }

  const ExplainedPixel& explained_;
  const Scene& scene_;
  const DisplayTransform& display_;
};

/// Calls `use` with the ends and the colour of each ray that is drawn. The camera ray is not drawn.
template <class Use>
void for_each_line(const ExplainedPixel& explained, const Use& use) {
  // Colours by the kind of ray: camera ray, mirror ray, refracted ray, and continuation behind a surface.
  static constexpr std::array<ImU32, 4> kColors = {kPixelColor, IM_COL32(90, 200, 255, 220),
                                                   IM_COL32(120, 255, 140, 220), IM_COL32(255, 255, 255, 120)};
  constexpr ImU32 kSeen = IM_COL32(255, 220, 90, 200);
  constexpr ImU32 kBlocked = IM_COL32(255, 90, 90, 160);
  for (const ExplainedSample& sample : explained.explanation.samples) {
    const ExplainedRay& first = sample.rays.front();
    const float reach = first.hit.object < 0 ? 1.0F : kMissShare * first.hit.t;
    for (const ExplainedRay& ray : sample.rays) {
      const vec3 end = ray.hit.object < 0 ? ray.ray.origin + reach * ray.ray.direction : ray.position;
      if (ray.kind != RayKind::kCamera) use(ray.ray.origin, end, kColors[static_cast<size_t>(ray.kind)]);
      for (const ExplainedSource& source : ray.sources) {
        if (!source.shadow_ray) continue;
        const Ray& shadow = *source.shadow_ray;
        use(shadow.origin, shadow.origin + std::min(reach, shadow.tmax) * shadow.direction,
            source.is_visible() ? kSeen : kBlocked);
      }
    }
  }
}

/// Calls `use` with the place of each point of the pixel's rays that the camera sees.
template <class Use>
void for_each_seen_place(const ExplainedPixel& explained, const FreeCamera& camera, double aspect_ratio,
                         const Use& use) {
  for (const ExplainedSample& sample : explained.explanation.samples) {
    const ExplainedRay& first = sample.rays.front();
    const bool is_hit = first.hit.object >= 0;
    const dvec3 point(is_hit ? first.position : first.ray.origin + first.ray.direction);
    if (const auto place = project(point, camera, aspect_ratio)) use(*place, is_hit);
  }
}

void draw_rays(const ExplainedPixel& explained, const FreeCamera& camera, const ImVec2& size) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const double aspect_ratio = double{size.x} / double{size.y};
  const auto on_window = [&](const dvec2& place) { return to_imgui(place * to_glm(size)); };
  for_each_line(explained, [&](const vec3& from, const vec3& to, ImU32 color) {
    const auto a = project(from, camera, aspect_ratio);
    const auto b = project(to, camera, aspect_ratio);
    if (a && b) list.AddLine(on_window(*a), on_window(*b), color, 1.5F);
  });
  for_each_seen_place(explained, camera, aspect_ratio, [&](const dvec2& place, bool is_hit) {
    if (is_hit) list.AddCircle(on_window(place), 5.0F, kPixelColor, 0, 1.5F);
  });
}

/// Returns the costs of hiding parts of the picture behind the panel.
ScreenCover find_costs(const ExplainedPixel& explained, const FreeCamera& camera, double aspect_ratio,
                       const std::optional<WindowArea>& other_panel) {
  constexpr float kRayCost = 3.0F;
  constexpr float kPanelCost = 10.0F;
  constexpr float kPixelCost = 1000.0F;
  ScreenCover cover = explained.cover;
  for_each_line(explained, [&](const vec3& from, const vec3& to, ImU32 /*color*/) {
    const auto a = project(from, camera, aspect_ratio);
    const auto b = project(to, camera, aspect_ratio);
    if (a && b) cover.raise_line(*a, *b, kRayCost);
  });
  if (other_panel) cover.raise_area(*other_panel, kPanelCost);
  for_each_seen_place(explained, camera, aspect_ratio,
                      [&](const dvec2& place, bool /*is_hit*/) { cover.raise(place, kPixelCost); });
  return cover;
}

/// Shows the tree in the current panel. Returns the size of a panel in which the tree fits.
dvec2 show_tree(const ExplainedPixel& explained, const DisplayTransform& display) {
  ImGui::BeginGroup();
  ExplanationTree(explained, display).show();
  ImGui::EndGroup();
  const dvec2 padding = to_glm(ImGui::GetStyle().WindowPadding);
  return to_glm(ImGui::GetItemRectSize()) + 2.0 * padding + dvec2(0.0, ImGui::GetFrameHeight());
}

/// Moves the current panel upwards if an opened branch extends it beyond the lower edge.
void stay_within(const ImVec2& window) {
  const float margin = overlay_margin();
  const float lowest = std::max(window.y - margin - ImGui::GetWindowHeight(), margin);
  if (ImGui::GetWindowPos().y > lowest) ImGui::SetWindowPos(ImVec2(ImGui::GetWindowPos().x, lowest));
}

}  // namespace

void ExplanationPanel::open(ExplainedPixel explained) {
  explained_ = std::move(explained);
  frames_to_place_ = kFramesToPlace;
}

void ExplanationPanel::show(const Camera& pose, const DisplayTransform& display,
                            const std::optional<WindowArea>& other_panel) {
  if (!explained_) return;
  const FreeCamera camera(pose);
  const ImVec2 window = ImGui::GetIO().DisplaySize;
  draw_rays(*explained_, camera, window);
  if (std::exchange(window_, to_glm(window)) != to_glm(window)) frames_to_place_ = kFramesToPlace;
  if (frames_to_place_ > 0) {
    --frames_to_place_;
    const ScreenCover costs = find_costs(*explained_, camera, window_.x / window_.y, other_panel);
    const dvec2 margin = double{overlay_margin()} / window_;
    ImGui::SetNextWindowPos(to_imgui(choose_corner(costs, size_ / window_, margin).lo * window_));
  }
  const double title_width = double{ImGui::CalcTextSize(explained_->title.c_str()).x + 4.0F * ImGui::GetFrameHeight()};
  const dvec2 least(title_width, ImGui::GetFrameHeight());
  const dvec2 most = glm::max(least, {kPanelShare * window_.x, window_.y - 2.0 * overlay_margin()});
  ImGui::SetNextWindowSizeConstraints(to_imgui(least), to_imgui(most));
  ImGui::SetNextWindowBgAlpha(0.75F);
  bool is_open = true;
  ImGui::Begin(
      (explained_->title + "###explanation").c_str(), &is_open,
      ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_HorizontalScrollbar | ImGuiWindowFlags_NoFocusOnAppearing);
  size_ = glm::clamp(show_tree(*explained_, display), least, most);
  stay_within(window);
  ImGui::End();
  if (!is_open) explained_.reset();
}

}  // namespace promin::app
