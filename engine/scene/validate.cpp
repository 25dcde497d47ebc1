// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/validate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <type_traits>

#include "core/rounding.h"
#include "scene/light_kinds.h"
#include "scene/limits.h"
#include "scene/texture_slots.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

/// The smallest determinant of a transform, relative to the lengths of its columns. A transform with a smaller one
/// flattens objects.
constexpr double kLeastVolume = 1e-12;
/// The largest error of the length of a light's direction. The cosines of spot lights are computed with the unchanged
/// direction.
constexpr float kDirectionTolerance = 1e-5F;
/// The largest error of the lengths of a camera's look and up, and of their dot product.
constexpr float kBasisTolerance = 1e-3F;
/// The largest power and colour. Products of larger ones overflow in fp32.
constexpr float kMaxPower = 1e15F;

/// The number of kinds of lights, which are numbered 0, 1, ...
constexpr uint32_t kLightKindCount = 0
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME) +1
#include "promin/kinds/lights.def"
    ;

/// The place of a part of a scene: "materials[3].ior". It is converted to text only if the part is wrong, because
/// scenes have millions of valid parts.
class Place {
 public:
  Place(const char* name) : name_(name) {}  // NOLINT(google-explicit-constructor): a name is a place.
  Place(const char* array, size_t index) : name_(array), index_(index) {}

  /// Returns the place of a member of this part. `member` must outlive the returned place.
  Place operator+(const char* member) const {
    Place part = *this;
    part.members_.at(part.member_count_++) = member;
    return part;
  }

  std::string text() const {
    std::ostringstream text;
    text << name_;
    if (index_) text << '[' << *index_ << ']';
    for (size_t i = 0; i < member_count_; ++i) text << members_.at(i);
    return text.str();
  }

 private:
  const char* name_;
  std::optional<size_t> index_;
  std::array<const char*, 4> members_{};
  size_t member_count_ = 0;
};

bool is_color(const vec3& color) {
  const auto is_power = [](float value) { return value >= 0.0F && value <= kMaxPower; };
  return is_power(color.r) && is_power(color.g) && is_power(color.b);
}

/// Describes the first component because of which a pixel is not a colour.
std::string describe_wrong_pixel(const vec3& pixel, const uvec2& place) {
  int channel = 0;
  while (channel < 2 && pixel[channel] >= 0.0F && pixel[channel] <= kMaxPower) ++channel;
  const float value = pixel[channel];
  const char* what = std::isnan(value) ? "not a number" : value < 0.0F ? "negative" : "beyond 1e15";
  std::ostringstream sentence;
  sentence << "a pixel of the panorama is " << what << " ("
           << "RGB"[channel] << " is " << value << " in pixel " << place.x << ", " << place.y << ")";
  return sentence.str();
}

/// Collects problems.
class Validation {
 public:
  explicit Validation(std::vector<Problem>& problems) : problems_(problems) {}

  /// Adds a problem unless `is_so`. `what` is a sentence, or a function that returns one.
  template <class What>
  bool check(ProblemCode code, bool is_so, const What& what, const Place& where, const char* cure) {
    if (is_so) return true;
    if constexpr (std::is_invocable_v<What>) {
      problems_.push_back({code, what(), where.text(), cure});
    } else {
      problems_.push_back({code, what, where.text(), cure});
    }
    return false;
  }

  void check_color(const vec3& color, const Place& where) {
    check("scene.color.range", is_color(color), "a colour or factor is negative, beyond 1e15 or not a number", where,
          "use numbers from 0 to 1e15");
  }

  void check_share(float share, const Place& where) {
    check("scene.weight.range", share >= 0.0F && share <= 1.0F, "a weight is not between 0 and 1", where,
          "use a number from 0 to 1");
  }

  void check_film(float thickness, const Place& where) {
    check("scene.number.range", thickness >= 0.0F && std::isfinite(thickness),
          "the thickness is negative or not finite", where, "use 0 or a positive number of nanometres");
  }

  void check_model(const Phong& phong, const Place& place) {
    check_color(phong.ambient, place + ".ambient");
    check_color(phong.diffuse, place + ".diffuse");
    check_color(phong.specular, place + ".specular");
    check_color(phong.reflection, place + ".reflection");
    check_color(phong.transmission, place + ".transmission");
    check("scene.number.range", phong.ior > 0.0F && std::isfinite(phong.ior),
          "the index of refraction is not positive and finite", place + ".ior", "use a number above 0");
    check("scene.number.range", std::isfinite(phong.shininess), "the shininess is not finite", place + ".shininess",
          "use a finite exponent");
  }

  void check_model(const MetallicRoughness& material, const Place& place) {
    for (int i = 0; i < 3; ++i) check_share(material.base_color[i], place + ".base_color");
    check_share(material.metallic, place + ".metallic");
    check_share(material.roughness, place + ".roughness");
    check_share(material.specular, place + ".specular");
    check("scene.number.range", std::isfinite(material.normal_scale), "the scale is not finite",
          place + ".normal_scale", "use a finite number");
    check_share(material.occlusion_strength, place + ".occlusion_strength");
    check_share(material.clearcoat, place + ".clearcoat");
    check_share(material.clearcoat_roughness, place + ".clearcoat_roughness");
    check("scene.number.range", std::isfinite(material.clearcoat_normal_scale), "the scale is not finite",
          place + ".clearcoat_normal_scale", "use a finite number");
    check_color(material.specular_color, place + ".specular_color");
    for (int i = 0; i < 3; ++i) check_share(material.sheen_color[i], place + ".sheen_color");
    check_share(material.sheen_roughness, place + ".sheen_roughness");
    check_share(material.transmission, place + ".transmission");
    check_share(material.diffuse_transmission, place + ".diffuse_transmission");
    for (int i = 0; i < 3; ++i) {
      check_share(material.diffuse_transmission_color[i], place + ".diffuse_transmission_color");
    }
    check_share(material.iridescence, place + ".iridescence");
    check("scene.number.range", material.iridescence_ior >= 1.0F && std::isfinite(material.iridescence_ior),
          "the index of refraction is below 1 or not finite", place + ".iridescence_ior", "use a number of 1 or more");
    check_film(material.iridescence_thickness_minimum, place + ".iridescence_thickness_minimum");
    check_film(material.iridescence_thickness_maximum, place + ".iridescence_thickness_maximum");
    check_share(material.anisotropy, place + ".anisotropy");
    check("scene.number.range", std::isfinite(material.anisotropy_rotation), "the angle is not finite",
          place + ".anisotropy_rotation", "use a finite number");
    check("scene.number.range", material.thickness >= 0.0F, "the thickness is negative or not a number",
          place + ".thickness", "use 0 or a positive number");
    for (int i = 0; i < 3; ++i) check_share(material.attenuation_color[i], place + ".attenuation_color");
    check("scene.number.range", material.attenuation_distance > 0.0F, "the distance is not positive",
          place + ".attenuation_distance", "use a positive number, or infinity if nothing is absorbed");
    check("scene.number.range", material.dispersion >= 0.0F && std::isfinite(material.dispersion),
          "the dispersion is negative or not finite", place + ".dispersion", "use 0 or a positive number");
    check("scene.number.range", material.ior == 0.0F || (material.ior >= 1.0F && std::isfinite(material.ior)),
          "the index of refraction is below 1 or not finite", place + ".ior", "use 0, or a number of 1 or more");
  }

  void check_model(const Unlit& unlit, const Place& place) { check_color(unlit.color, place + ".color"); }

  void check_place(const TextureSlot& slot, const Place& place) {
    check("scene.texture.set", slot.uv_set <= 1, "the set of texture coordinates is neither 0 nor 1", place + ".uv_set",
          "use 0 or 1");
    check("scene.texture.transform", is_finite(slot.to_u) && is_finite(slot.to_v), "the transform is not finite", place,
          "use finite numbers");
  }

  void check_materials(std::span<const Material> materials) {
    for (size_t i = 0; i < materials.size(); ++i) {
      const Material& material = materials[i];
      const Place place("materials", i);
      std::visit([&](const auto& model) { check_model(model, place); }, material.model);
      check_color(material.emissive, place + ".emissive");
      for_each_slot(material, [&](const TextureSlot& slot, const char* name, ImageUse /*use*/) {
        if (slot.exists()) check_place(slot, place + "." + name);
      });
      check("scene.choice.unknown",
            static_cast<uint32_t>(material.alpha_mode) <= static_cast<uint32_t>(AlphaMode::kBlend),
            "the alpha mode is not a value of AlphaMode", place + ".alpha_mode", "use one of its values");
      check_share(material.alpha, place + ".alpha");
      check("scene.number.range", std::isfinite(material.alpha_cutoff) && material.alpha_cutoff >= 0.0F,
            "the alpha cutoff is negative or not finite", place + ".alpha_cutoff", "use a number of 0 or more");
    }
  }

  void check_images(const Scene& scene) {
    for (size_t i = 0; i < scene.images.size(); ++i) {
      const Place place("images", i);
      if (!check("scene.image.missing", scene.images[i] != nullptr, "the texture's image is missing", place,
                 "give an empty image if the texture has none"))
        continue;
      const TextureImage& image = *scene.images[i];
      check("scene.choice.unknown", static_cast<uint32_t>(image.use) <= static_cast<uint32_t>(ImageUse::kNormal),
            "the image's use is not a value of ImageUse", place + ".use", "use one of its values");
      if (image.texels.empty()) continue;
      check(
          "scene.image.size", image.size.x <= kMaxTextureSide && image.size.y <= kMaxTextureSide,
          [] { return "an image has a side longer than " + std::to_string(kMaxTextureSide); }, place + ".size",
          "make it smaller");
      check(
          "scene.image.texels", image.texels.size() == uint64_t{image.size.x} * image.size.y,
          [&] { return "the number of texels (" + std::to_string(image.texels.size()) + ") does not match the size"; },
          place + ".texels", "give one texel for each pixel, or no texels");
    }
    for (size_t i = 0; i < scene.textures.size(); ++i) {
      const Texture& texture = scene.textures[i];
      const Place place("textures", i);
      check("scene.reference.range", texture.image < scene.images.size(), "the image is out of range", place + ".image",
            "use one that exists");
      for (const TextureWrap wrap : {texture.wrap_u, texture.wrap_v}) {
        check("scene.choice.unknown", static_cast<uint32_t>(wrap) <= static_cast<uint32_t>(TextureWrap::kClampToEdge),
              "the wrap mode is not a value of TextureWrap", place, "use one that exists");
      }
    }
  }

  /// The number of textures is known only if a whole scene is checked.
  void check_slot(const TextureSlot& slot, size_t texture_count, const Place& place) {
    if (!slot.exists()) return;
    check("scene.reference.range", slot.texture < texture_count, "the texture is out of range", place + ".texture",
          "use one that exists");
  }

  void check_slots(const Scene& scene) {
    for (size_t i = 0; i < scene.materials.size(); ++i) {
      for_each_slot(scene.materials[i], [&](const TextureSlot& slot, const char* name, ImageUse /*use*/) {
        check_slot(slot, scene.textures.size(), Place("materials", i) + "." + name);
      });
    }
  }

  void check_lights(std::span<const Light> lights) {
    for (size_t i = 0; i < lights.size(); ++i) {
      const Light& light = lights[i];
      const Place place("lights", i);
      check_color(light.diffuse, place + ".diffuse");
      check_color(light.specular, place + ".specular");
      check("scene.position.range", is_in_range(dvec3(light.position)), "the position is beyond 1e15 or not finite",
            place + ".position", "use a smaller coordinate");
      check("scene.light.direction", std::abs(glm::length(light.direction) - 1.0F) <= kDirectionTolerance,
            "the direction is not a unit vector", place + ".direction", "normalise it");
      check("scene.choice.unknown", static_cast<uint32_t>(light.kind) < kLightKindCount,
            "the light's kind is not a value of LightKind", place + ".kind", "use one of its values");
      check("scene.choice.unknown",
            light.attenuation == Attenuation::kNone || light.attenuation == Attenuation::kInverseSquare,
            "the attenuation is not a value of Attenuation", place + ".attenuation", "use one of its values");
      check("scene.light.range", light.range > 0.0F, "the range is not positive", place + ".range",
            "use a positive number, or infinity for no limit");
      const bool are_angles = light.inner_cone_angle >= 0.0F && light.inner_cone_angle < light.outer_cone_angle &&
                              light.outer_cone_angle <= 1.5707964F;
      check("scene.light.cone", light.kind != LightKind::kSpot || are_angles,
            "the cone's angles are out of range, or the inner angle is not less than the outer angle",
            place + ".outer_cone_angle", "use 0 <= inner < outer <= pi/2");
      check("scene.light.size", light.radius >= 0.0F && static_cast<double>(light.radius) <= kMaxCoordinate,
            "the radius is negative, beyond 1e15 or not a number", place + ".radius", "use a number from 0 to 1e15");
      const bool is_flat_size = std::min(light.size.x, light.size.y) >= kLeastLightSide &&
                                static_cast<double>(std::max(light.size.x, light.size.y)) <= kMaxCoordinate;
      check("scene.light.size", !is_flat(light.kind) || is_flat_size,
            "a side is smaller than 1e-15, beyond 1e15 or not a number", place + ".size",
            "use a positive width and height");
      check("scene.light.size", light.kind != LightKind::kDisk || light.size.x == light.size.y,
            "the disk has two different diameters", place + ".size", "make them equal");
      const bool is_across = std::abs(glm::length(light.right) - 1.0F) <= kDirectionTolerance &&
                             std::abs(glm::dot(light.right, light.direction)) <= kDirectionTolerance;
      check("scene.light.direction", !is_flat(light.kind) || is_across,
            "the direction of the width is not a unit vector at a right angle to the light's direction",
            place + ".right", "make it perpendicular to direction, and normalise it");
      check("scene.light.size", light.angle >= 0.0F && light.angle <= 3.1415927F,
            "the angle is negative, beyond pi or not a number", place + ".angle",
            "use an angle from 0 to pi, in radians");
    }
  }

  void check_environment(const Environment& environment) {
    check_color(environment.ambient, "environment.ambient");
    check_color(environment.background, "environment.background");
    check("scene.environment.up", std::abs(glm::length(environment.up) - 1.0F) <= kDirectionTolerance,
          "the sky's upward direction is not a unit vector", "environment.up", "normalise it");
    check("scene.number.range", std::isfinite(environment.rotation), "the rotation is not finite",
          "environment.rotation", "use an angle");
    check("scene.number.range", environment.intensity >= 0.0F && environment.intensity <= kMaxPower,
          "the intensity is negative, beyond 1e15 or not a number", "environment.intensity",
          "use a number from 0 to 1e15");
    std::visit([&](const auto& sky) { check_sky(sky); }, environment.sky);
    if (environment.backdrop) check_backdrop(*environment.backdrop);
  }

  void check_backdrop(const Backdrop& backdrop) {
    check_color(backdrop.top, "environment.backdrop.top");
    check_color(backdrop.bottom, "environment.backdrop.bottom");
    check("scene.number.range", backdrop.radiance >= 0.0F && backdrop.radiance <= kMaxPower,
          "the factor is negative, beyond 1e15 or not a number", "environment.backdrop.radiance",
          "use a number from 0 to 1e15");
  }

  void check_sky(std::monostate) {}

  void check_sky(const Studio& studio) {
    check("scene.number.range", std::isfinite(studio.front), "the sky's front angle is not finite",
          "environment.sky.front", "use an angle");
  }

  void check_sky(const GradientSky& sky) {
    check_color(sky.top, "environment.sky.top");
    check_color(sky.horizon, "environment.sky.horizon");
    check_color(sky.bottom, "environment.sky.bottom");
    const auto check_curve = [&](float curve, const Place& where) {
      check("scene.number.range", curve > 0.0F && std::isfinite(curve), "the curve is not positive", where,
            "use a positive number; 1 gives an even transition");
    };
    check_curve(sky.top_curve, "environment.sky.top_curve");
    check_curve(sky.bottom_curve, "environment.sky.bottom_curve");
  }

  void check_sky(const Panorama& panorama) {
    const Place place = "environment.sky.image";
    if (!check("scene.panorama.missing", panorama.image != nullptr, "the panorama has no image", place,
               "give it an image"))
      return;
    const Image& image = *panorama.image;
    const uint64_t pixel_count = uint64_t{image.size.x} * image.size.y;
    if (!check("scene.panorama.size", pixel_count > 0 && pixel_count == image.pixels.size(),
               "the number of the panorama's pixels does not match its size", place + ".pixels",
               "give width times height pixels") ||
        !check("scene.panorama.size", image.size.x <= Panorama::kMaxWidth && image.size.y <= Panorama::kMaxHeight,
               "the panorama is larger than 16384x8192", place + ".size", "make it smaller")) {
      return;
    }
    const auto wrong = std::ranges::find_if_not(image.pixels, is_color);
    if (wrong == image.pixels.end()) return;
    const auto index = static_cast<size_t>(wrong - image.pixels.begin());
    check("scene.panorama.pixel", false, describe_wrong_pixel(*wrong, {index % image.size.x, index / image.size.x}),
          place + ".pixels", "use numbers from 0 to 1e15");
  }

  void check_cameras(std::span<const Camera> cameras) {
    for (size_t i = 0; i < cameras.size(); ++i) {
      const Place place("cameras", i);
      check("scene.camera.eye", is_in_range(dvec3(cameras[i].eye)), "the eye is beyond 1e15 or not finite",
            place + ".eye", "use a smaller coordinate");
      const uvec2& resolution = cameras[i].resolution;
      const bool is_size = std::min(resolution.x, resolution.y) > 0 && std::max(resolution.x, resolution.y) <= kMaxSide;
      check("scene.camera.resolution", resolution == uvec2(0) || is_size,
            "the resolution has a side of 0 or over 32768", place + ".resolution",
            "use sides of 1 to 32768, or 0 0 for no resolution");
      check_camera(cameras[i], place);
    }
  }

  void check_camera(const Camera& camera, const Place& place) {
    const bool is_basis = std::abs(glm::length(camera.look) - 1.0F) <= kBasisTolerance &&
                          std::abs(glm::length(camera.up) - 1.0F) <= kBasisTolerance &&
                          std::abs(glm::dot(camera.look, camera.up)) <= kBasisTolerance;
    check("scene.camera.basis", is_basis, "look and up are not orthonormal", place, "use perpendicular unit vectors");
    check("scene.choice.unknown",
          camera.projection == Projection::kPerspective || camera.projection == Projection::kOrthographic,
          "the projection is not a value of Projection", place + ".projection", "use one of its values");
    check("scene.camera.range", camera.yfov > 0.0F && camera.yfov < 3.14159265F, "the field of view is out of range",
          place + ".yfov", "use an angle in (0, pi)");
    check("scene.camera.range", camera.ymag > 0.0F && std::isfinite(camera.ymag), "the half height is not positive",
          place + ".ymag", "use a positive number");
    check("scene.camera.range", camera.near >= 0.0F && std::isfinite(camera.near), "the near plane lies behind the eye",
          place + ".near", "use a distance of 0 or more");
    check("scene.camera.lens",
          camera.aperture_radius >= 0.0F && static_cast<double>(camera.aperture_radius) <= kMaxCoordinate,
          "the lens has a radius that is negative, beyond 1e15 or not a number", place + ".aperture_radius",
          "use a number from 0 to 1e15");
    const bool is_focused =
        camera.focus_distance >= kLeastFocusDistance && static_cast<double>(camera.focus_distance) <= kMaxCoordinate;
    check("scene.camera.lens", !(camera.aperture_radius > 0.0F) || is_focused,
          "the lens has no plane in focus in front of it", place + ".focus_distance",
          "use a distance from 1e-15 to 1e15");
  }

  void check_view(const View& view) {
    // The eye may have coordinates beyond 1e15, because a camera that frames a scene of that size may be there.
    check("scene.camera.eye", is_finite(view.camera.eye), "the eye is not finite", "view.camera.eye",
          "use finite coordinates");
    check_camera(view.camera, "view.camera");
    check("view.size.range", view.size.x > 0 && view.size.y > 0, "the picture has no pixels", "view.size",
          "give it a width and a height");
    check("view.size.range", std::max(view.size.x, view.size.y) <= kMaxSide,
          "a side of the picture is longer than 32768 pixels", "view.size", "use at most 32768");
    check("view.samples.range", view.samples_per_pixel >= 1 && view.samples_per_pixel <= kMaxSamplesPerPixel,
          "the number of samples per pixel is out of range", "view.samples_per_pixel", "use 1 to 65535");
    check("scene.choice.unknown", static_cast<size_t>(view.filter) < pixel_filter_names().size(),
          "the filter is not a value of PixelFilter", "view.filter", "use one of its values");
    check("view.occlusion.range", view.occlusion_distance >= 0.0F && view.occlusion_distance <= 1e15F,
          "the distance of occlusion is out of range", "view.occlusion_distance", "use 0 to 1e15");
    check("view.filter.range", view.filter_width >= kMinFilterWidth && view.filter_width <= kMaxFilterWidth,
          "the filter width is out of range", "view.filter_width", "use 0.01 to 32 pixels");
    check("view.depth.range", view.max_depth <= kMaxDepth, "the number of bounces is out of range", "view.max_depth",
          "use 0 to 1000");
    check("scene.choice.unknown", static_cast<size_t>(view.mode.debug_view) < debug_view_names().size(),
          "the debug view is not a value of DebugView", "view.mode.debug_view", "use one of its values");
    if (view.error_target) check_error_target(view);
    if (!view.crop) return;
    check("view.crop.empty", view.crop->lo.x < view.crop->hi.x && view.crop->lo.y < view.crop->hi.y,
          "the crop contains no pixels", "view.crop", "use lo < hi");
    check("view.crop.outside", view.crop->hi.x <= view.size.x && view.crop->hi.y <= view.size.y,
          "the crop extends beyond the picture", "view.crop", "use a crop inside the picture");
  }

  void check_error_target(const View& view) {
    const ErrorTarget& target = *view.error_target;
    check("view.target.range", target.error >= kMinTargetError && target.error <= 1.0F,
          "the target error is out of range", "view.error_target.error", "use 1/65536 to 1");
    check("view.target.range", std::has_single_bit(target.min_samples) && target.min_samples >= kMinRefinedSamples,
          "the smallest number of samples is out of range or not a power of two", "view.error_target.min_samples",
          "use a power of two of 4 or more");
    check("view.target.range",
          std::has_single_bit(target.max_samples) && target.max_samples >= target.min_samples &&
              target.max_samples <= kMaxRefinedSamples,
          "the largest number of samples is out of range or not a power of two", "view.error_target.max_samples",
          "use a power of two from the smallest number to 32768");
    check("view.target.range", target.white > 0.0F && std::isfinite(target.white),
          "the radiance that is shown as white is not positive and finite", "view.error_target.white",
          "use 1, or 2 to the power of -EV");
    if (target.display) {
      check("view.target.range", std::isfinite(target.display->exposure_ev), "the exposure is not finite",
            "view.error_target.display.exposure_ev", "use 0, or the exposure of the picture's display");
      check("scene.choice.unknown", static_cast<size_t>(target.display->tone_mapping) < tone_mapping_names().size(),
            "the tone mapping is not a value of ToneMapping", "view.error_target.display.tone_mapping",
            "use one of its values");
    }
    check("view.target.debug", view.mode.debug_view == DebugView::kNone, "a debug view has no error estimate",
          "view.error_target", "remove the error target or the debug view");
  }

  void check_geometry(const Scene& scene, size_t index) {
    if (const auto* mesh = std::get_if<Mesh>(&scene.geometries[index])) {
      check_mesh(*mesh, scene, Place("geometries", index));
    }
  }

  /// Checks an object's references. Returns false if one does not exist.
  bool check_references(const Scene& scene, size_t index) {
    const Object& object = scene.objects[index];
    const Place place("objects", index);
    const auto describe = [](const char* kind, uint32_t named, size_t count) {
      return [=] {
        return std::string("the ") + kind + " " + std::to_string(named) +
               " does not exist, because the scene has only " + std::to_string(count);
      };
    };
    const bool has_material = check("scene.reference.range", object.material < scene.materials.size(),
                                    describe("material", object.material, scene.materials.size()), place + ".material",
                                    "use one that exists");
    const bool has_geometry = check("scene.reference.range", object.geometry < scene.geometries.size(),
                                    describe("geometry", object.geometry, scene.geometries.size()), place + ".geometry",
                                    "use one that exists, or Object::kNoGeometry");
    return has_material && has_geometry;
  }

  void check_transform(const Object& object, const Place& place) {
    std::optional<Problem> problem = find_transform_problem(object.world_from_object);
    if (!problem) return;
    problem->where = place.text();
    problems_.push_back(std::move(*problem));
  }

  /// Checks an object whose references all exist.
  void check_placed(const Scene& scene, size_t index) {
    const Object& object = scene.objects[index];
    const Place place("objects", index);
    const size_t before = problems_.size();
    check_transform(object, place + ".world_from_object");
    if (problems_.size() > before) return;
    std::visit([&](const auto& geometry) { check_in_world(geometry, object, place); },
               scene.geometries[object.geometry]);
  }

 private:
  void check_in_world(const Mesh& mesh, const Object& object, const Place& place) {
    // Objects that share a mesh have the same box.
    const auto [known, is_new] = boxes_.try_emplace(&mesh);
    Bounds& box = known->second;
    for (size_t i = 0; is_new && i < mesh.positions.size(); ++i) box.extend(mesh.positions[i]);
    check("scene.position.far", mesh.positions.empty() || is_in_range(box, object.world_from_object),
          "the mesh extends beyond 1e15 in the world", place, "use a smaller translation or scale");
  }

  template <class Shape>
  void check_in_world(const Shape& shape, const Object& object, const Place& place) {
    const Placement placement(object.world_from_object);
    if (!check("scene.shape.distorted", promin::place(shape, placement).has_value(), "the transform distorts the shape",
               place + ".world_from_object", "scale all axes equally, or use a mesh")) {
      return;
    }
    check("scene.position.far", is_in_range(center_of(shape, placement)), "the shape lies beyond 1e15 in the world",
          place, "use a smaller translation");
    for (const NamedSize& size : sizes_of(shape, placement)) {
      check(
          "scene.shape.size", is_valid(size),
          [&] { return "the " + std::string(size.name) + " is " + std::to_string(size.size) + " in the world"; }, place,
          "use sizes and scales that keep it between 1e-22 and 1e15");
    }
  }

  /// Returns the first wrong element, if there is one.
  template <class Elements, class IsRight>
  void check_each(ProblemCode code, const Elements& elements, const IsRight& is_right, const char* what,
                  const Place& place, const char* cure) {
    const auto wrong = std::find_if_not(elements.begin(), elements.end(), is_right);
    if (wrong == elements.end()) return;
    problems_.push_back({code, what, place.text() + "[" + std::to_string(wrong - elements.begin()) + "]", cure});
  }

  void check_mesh(const Mesh& mesh, const Scene& scene, const Place& place) {
    const size_t vertices = mesh.positions.size();
    check_each(
        "scene.position.range", mesh.positions, [](const vec3& p) { return is_in_range(dvec3(p)); },
        "a vertex coordinate is beyond 1e15 or not finite", place + ".positions", "use a larger unit of length");
    check_each(
        "scene.normal.range", mesh.normals, [](const vec3& n) { return is_finite(n) && n != vec3(0.0F); },
        "a normal has length 0 or is not finite", place + ".normals", "remove the normals, or give each a direction");
    check_each(
        "scene.color.range", mesh.colors, [](const vec4& c) { return is_color(vec3(c)) && std::isfinite(c.a); },
        "a vertex colour is negative, beyond 1e15 or not a number", place + ".colors", "use numbers from 0 to 1e15");
    check_each(
        "scene.uv.range", mesh.uvs,
        [](const vec4& uv) { return is_in_range(dvec3(uv)) && std::abs(uv.w) <= kMaxCoordinate; },
        "a texture coordinate is beyond 1e15 or not finite", place + ".uvs", "use smaller coordinates");
    check_each(
        "scene.tangent.range", mesh.tangents,
        [](const vec4& t) { return is_finite(vec3(t)) && vec3(t) != vec3(0.0F) && std::abs(t.w) == 1.0F; },
        "a tangent has length 0, is not finite, or has a handedness that is neither 1 nor -1", place + ".tangents",
        "remove the tangents, or give each a direction and a handedness");
    check_each(
        "scene.reference.range", mesh.triangles,
        [&](const uvec3& t) { return t.x < vertices && t.y < vertices && t.z < vertices; },
        "the index of a corner exceeds the number of positions", place + ".triangles",
        "use indices of existing positions");
    check_each(
        "scene.reference.range", mesh.triangle_materials,
        [&](uint32_t material) { return material < scene.materials.size(); }, "a material is out of range",
        place + ".triangle_materials", "use one that exists");
    const auto check_count = [&](size_t count, size_t wanted, const char* array, const char* one) {
      check(
          "scene.array.count", count == 0 || count == wanted,
          [&] { return "there are " + std::to_string(count) + " values for " + std::to_string(wanted) + one; },
          place + array, "give one value for each, or no values");
    };
    check_count(mesh.normals.size(), vertices, ".normals", " positions");
    check_count(mesh.colors.size(), vertices, ".colors", " positions");
    check_count(mesh.uvs.size(), vertices, ".uvs", " positions");
    check_count(mesh.tangents.size(), vertices, ".tangents", " positions");
    check_count(mesh.triangle_materials.size(), mesh.triangles.size(), ".triangle_materials", " triangles");
  }

  std::vector<Problem>& problems_;
  /// The box of each mesh that an object shows.
  std::map<const Mesh*, Bounds> boxes_;
};

}  // namespace

std::optional<Problem> find_transform_problem(const dmat4& world_from_object) {
  const dmat4& m = world_from_object;
  if (!is_finite(m)) return Problem{"scene.transform.range", "the transform is not finite", "", "use finite numbers"};
  if (m[0][3] != 0.0 || m[1][3] != 0.0 || m[2][3] != 0.0 || m[3][3] != 1.0) {
    return Problem{"scene.transform.affine", "the transform is not affine", "", "make its last row 0 0 0 1"};
  }
  const dmat3 linear(m);
  const double volume = std::abs(glm::determinant(linear));
  const double lengths = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
  if (volume > kLeastVolume * lengths && std::isfinite(lengths)) return std::nullopt;
  return Problem{"scene.transform.singular", "the transform is singular", "",
                 "use non-zero scales and axes that differ"};
}

std::vector<Problem> validate(const Scene& scene) {
  std::vector<Problem> problems;
  Validation validation(problems);
  validation.check_materials(scene.materials);
  validation.check_images(scene);
  validation.check_slots(scene);
  validation.check_lights(scene.lights);
  validation.check_cameras(scene.cameras);
  validation.check_environment(scene.environment);
  for (size_t i = 0; i < scene.geometries.size(); ++i) validation.check_geometry(scene, i);
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].geometry == Object::kNoGeometry) continue;
    if (validation.check_references(scene, i)) validation.check_placed(scene, i);
  }
  return problems;
}

std::vector<Problem> validate(std::span<const Light> lights) {
  std::vector<Problem> problems;
  Validation(problems).check_lights(lights);
  return problems;
}

std::vector<Problem> validate(std::span<const Material> materials) {
  std::vector<Problem> problems;
  Validation(problems).check_materials(materials);
  return problems;
}

std::vector<Problem> validate(const Environment& environment) {
  std::vector<Problem> problems;
  Validation(problems).check_environment(environment);
  return problems;
}

std::vector<Problem> validate(const View& view) {
  std::vector<Problem> problems;
  Validation(problems).check_view(view);
  return problems;
}

}  // namespace promin
