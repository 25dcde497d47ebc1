// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/show_explanation.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "camera.h"

namespace promin::app {
namespace {

/// The shares of the width and the height of the window that the panel takes.
constexpr float kPanelShare = 0.32F;
constexpr float kHeightShare = 0.9F;
/// How far a ray that hits nothing is drawn, in the way of the camera's ray.
constexpr float kMissShare = 0.5F;

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
  /// A line with a swatch of its color.
  void show_row(const std::string& text, const vec3& color) const {
    ImGui::PushID(&color);
    const float side = ImGui::GetTextLineHeight();
    ImGui::ColorButton("##color", to_imgui(color, display_), ImGuiColorEditFlags_NoTooltip, ImVec2(side, side));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%g %g %g", color.x, color.y, color.z);
    ImGui::PopID();
    ImGui::SameLine();
    ImGui::TextUnformatted(text.c_str());
  }

  std::string describe(const ExplainedRay& ray) const {
    static constexpr std::array kNames = {"the camera sees", "mirrored:", "refracted:", "behind it:"};
    std::string text = kNames[static_cast<size_t>(ray.kind)];
    if (ray.kind != RayKind::kCamera) {
      const float weight = std::max({ray.weight.x, ray.weight.y, ray.weight.z});
      text += fmt::format(" {:.3g} % of", 100.0F * weight);
    }
    if (ray.hit.object < 0) return text + " the background";
    const auto object = static_cast<uint32_t>(ray.hit.object);
    return text + fmt::format(" {}, {}", name_or(scene_.objects[object].name, "object", object),
                              name_or(scene_.materials[ray.material].name, "material", ray.material));
  }

  void show_source(const ExplainedSource& source) const {
    const std::string name = name_or(scene_.lights[source.light].name, "light", source.light);
    if (source.is_visible()) return show_row(name, source.contribution);
    if (!source.shadow_ray) return show_row(name + " does not reach it", source.contribution);
    const auto blocker = static_cast<uint32_t>(std::max(source.blocker.object, 0));
    show_row(fmt::format("{} is behind {}", name, name_or(scene_.objects[blocker].name, "object", blocker)),
             source.contribution);
  }

  void show_ray(const ExplainedSample& sample, uint32_t index) const {
    const ExplainedRay& ray = sample.rays[index];
    ImGui::PushID(static_cast<int>(index));
    const bool is_open = ImGui::TreeNodeEx("ray", ImGuiTreeNodeFlags_DefaultOpen, "%s", describe(ray).c_str());
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

/// Where the window shows a point, in its coordinates; none where it lies behind the camera.
std::optional<ImVec2> project(const vec3& point, const FreeCamera& camera, const ImVec2& size) {
  const dvec3 way = dvec3(point) - camera.position();
  const double ahead = glm::dot(way, camera.look());
  if (!(ahead > 0.0)) return std::nullopt;
  const bool is_perspective = camera.camera().projection == Projection::kPerspective;
  const double half =
      is_perspective ? ahead * std::tan(0.5 * double{camera.camera().yfov}) : double{camera.camera().ymag};
  const double scale = 0.5 * double{size.y} / half;
  return ImVec2(static_cast<float>(0.5 * double{size.x} + scale * glm::dot(way, camera.right())),
                static_cast<float>(0.5 * double{size.y} - scale * glm::dot(way, camera.up())));
}

void draw_rays(const ExplainedPixel& explained, const Camera& pose) {
  // By the kind of the ray: from the camera, mirrored, refracted, the same from behind a surface.
  static constexpr std::array<ImU32, 4> kColors = {IM_COL32(255, 255, 255, 220), IM_COL32(90, 200, 255, 220),
                                                   IM_COL32(120, 255, 140, 220), IM_COL32(255, 255, 255, 120)};
  constexpr ImU32 kSeen = IM_COL32(255, 220, 90, 200);
  constexpr ImU32 kBlocked = IM_COL32(255, 90, 90, 160);
  const FreeCamera camera(pose);
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto draw = [&](const vec3& from, const vec3& to, ImU32 color) {
    const auto a = project(from, camera, size);
    const auto b = project(to, camera, size);
    if (a && b) list.AddLine(*a, *b, color, 1.5F);
  };
  for (const ExplainedSample& sample : explained.explanation.samples) {
    const ExplainedRay& first = sample.rays.front();
    const float reach = first.hit.object < 0 ? 1.0F : kMissShare * first.hit.t;
    for (const ExplainedRay& ray : sample.rays) {
      const vec3 end = ray.hit.object < 0 ? ray.ray.origin + reach * ray.ray.direction : ray.position;
      if (ray.kind != RayKind::kCamera) draw(ray.ray.origin, end, kColors[static_cast<size_t>(ray.kind)]);
      for (const ExplainedSource& source : ray.sources) {
        if (!source.shadow_ray) continue;
        const Ray& shadow = *source.shadow_ray;
        draw(shadow.origin, shadow.origin + std::min(reach, shadow.tmax) * shadow.direction,
             source.is_visible() ? kSeen : kBlocked);
      }
    }
    if (first.hit.object < 0) continue;
    if (const auto place = project(first.position, camera, size)) list.AddCircle(*place, 5.0F, kColors[0], 0, 1.5F);
  }
}

}  // namespace

bool show_explanation(const ExplainedPixel& explained, const Camera& camera, const DisplayTransform& display) {
  bool is_open = true;
  draw_rays(explained, camera);
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float margin = 0.5F * (1.0F - kHeightShare) * size.y;
  ImGui::SetNextWindowPos(ImVec2(size.x - margin, margin), ImGuiCond_Appearing, ImVec2(1.0F, 0.0F));
  ImGui::SetNextWindowSize(ImVec2(kPanelShare * size.x, kHeightShare * size.y), ImGuiCond_Appearing);
  ImGui::SetNextWindowBgAlpha(0.75F);
  ImGui::Begin((explained.title + "###explanation").c_str(), &is_open,
               ImGuiWindowFlags_HorizontalScrollbar | ImGuiWindowFlags_NoFocusOnAppearing);
  ExplanationTree(explained, display).show();
  ImGui::End();
  return is_open;
}

}  // namespace promin::app
