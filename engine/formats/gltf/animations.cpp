// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/animations.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "core/count_of.h"
#include "core/parse_number.h"
#include "core/utf8.h"
#include "formats/gltf/accessors.h"
#include "formats/gltf/buffers.h"
#include "formats/gltf/checks.h"
#include "formats/gltf/json_lookup.h"
#include "motion/node_state.h"
#include "motion/sampler.h"

namespace promin {
namespace {

using nlohmann::json;

constexpr const char* kStandsStill = "what it changes stands still";
constexpr const char* kWriteAgain = "export the file again";
/// The smallest square of a quaternion's length that has a direction.
constexpr double kLeastSquare = 1e-12;
/// The largest number of numbers of all animations. Samplers may share accessors, so the file's size does not limit it.
constexpr uint64_t kMaxNumbers = uint64_t{1} << 27;

/// A pointer of the glTF Asset Object Model: the part after the element's index, and the property. Elements are in the
/// array at `array`.
struct Pointer {
  std::string_view array;
  std::string_view member;
  AnimatedProperty property;
};

constexpr std::string_view kLights = "/extensions/KHR_lights_punctual/lights/";

constexpr Pointer kPointers[] = {
    {"/nodes/", "translation", AnimatedProperty::kTranslation},
    {"/nodes/", "rotation", AnimatedProperty::kRotation},
    {"/nodes/", "scale", AnimatedProperty::kScale},
    {"/nodes/", "weights", AnimatedProperty::kWeights},
    {"/nodes/", "weights/", AnimatedProperty::kWeight},
    {"/nodes/", "extensions/KHR_node_visibility/visible", AnimatedProperty::kVisibility},
    {"/meshes/", "weights", AnimatedProperty::kWeights},
    {"/meshes/", "weights/", AnimatedProperty::kWeight},
    {kLights, "color", AnimatedProperty::kLightColor},
    {kLights, "intensity", AnimatedProperty::kLightIntensity},
    {kLights, "range", AnimatedProperty::kLightRange},
    {kLights, "spot/innerConeAngle", AnimatedProperty::kInnerConeAngle},
    {kLights, "spot/outerConeAngle", AnimatedProperty::kOuterConeAngle},
    {"/cameras/", "perspective/yfov", AnimatedProperty::kYfov},
    {"/cameras/", "perspective/aspectRatio", AnimatedProperty::kAspectRatio},
    {"/cameras/", "perspective/znear", AnimatedProperty::kNear},
    {"/cameras/", "orthographic/xmag", AnimatedProperty::kXmag},
    {"/cameras/", "orthographic/ymag", AnimatedProperty::kYmag},
    {"/cameras/", "orthographic/znear", AnimatedProperty::kNear},
    {"/materials/", "pbrMetallicRoughness/baseColorFactor", AnimatedProperty::kBaseColor},
    {"/materials/", "emissiveFactor", AnimatedProperty::kEmissive},
    {"/materials/", "extensions/KHR_materials_emissive_strength/emissiveStrength", AnimatedProperty::kEmissiveStrength},
    {"/materials/", "alphaCutoff", AnimatedProperty::kAlphaCutoff},
#define PROMIN_MATERIAL_FACTOR(ENUMERATOR, MEMBER, COMPONENTS, MIN, MAX, POINTER) \
  {"/materials/", POINTER, AnimatedProperty::ENUMERATOR},
#include "promin/kinds/animated.def"
};

/// A texture of a material: its place in the material, and the member of the slot.
struct SlotPlace {
  std::string_view place;
  std::string_view member;
};

#define PROMIN_EXTENSION(NAME) "extensions/KHR_materials_" NAME
constexpr SlotPlace kSlots[] = {
    {"pbrMetallicRoughness/baseColorTexture", "base_color_texture"},
    {"pbrMetallicRoughness/metallicRoughnessTexture", "metallic_roughness_texture"},
    {"normalTexture", "normal_texture"},
    {"occlusionTexture", "occlusion_texture"},
    {"emissiveTexture", "emissive_texture"},
    {PROMIN_EXTENSION("transmission/transmissionTexture"), "transmission_texture"},
    {PROMIN_EXTENSION("diffuse_transmission/diffuseTransmissionTexture"), "diffuse_transmission_texture"},
    {PROMIN_EXTENSION("diffuse_transmission/diffuseTransmissionColorTexture"), "diffuse_transmission_color_texture"},
    {PROMIN_EXTENSION("specular/specularTexture"), "specular_texture"},
    {PROMIN_EXTENSION("specular/specularColorTexture"), "specular_color_texture"},
    {PROMIN_EXTENSION("clearcoat/clearcoatTexture"), "clearcoat_texture"},
    {PROMIN_EXTENSION("clearcoat/clearcoatRoughnessTexture"), "clearcoat_roughness_texture"},
    {PROMIN_EXTENSION("clearcoat/clearcoatNormalTexture"), "clearcoat_normal_texture"},
    {PROMIN_EXTENSION("sheen/sheenColorTexture"), "sheen_color_texture"},
    {PROMIN_EXTENSION("sheen/sheenRoughnessTexture"), "sheen_roughness_texture"},
    {PROMIN_EXTENSION("iridescence/iridescenceTexture"), "iridescence_texture"},
    {PROMIN_EXTENSION("iridescence/iridescenceThicknessTexture"), "iridescence_thickness_texture"},
    {PROMIN_EXTENSION("anisotropy/anisotropyTexture"), "anisotropy_texture"},
};
#undef PROMIN_EXTENSION

constexpr std::string_view kMaterials = "/materials/";
constexpr std::string_view kTransform = "/extensions/KHR_texture_transform/";

/// The members of KHR_texture_transform.
constexpr std::pair<std::string_view, AnimatedProperty> kTransformParts[] = {
    {"offset", AnimatedProperty::kTextureOffset},
    {"rotation", AnimatedProperty::kTextureRotation},
    {"scale", AnimatedProperty::kTextureScale},
};

/// Removes this begin of a text. Returns false if the text begins otherwise.
bool drop_begin(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

/// The property that a channel changes, and the indices of its targets. A pointer to the weights of a mesh has several.
struct Target {
  AnimatedProperty property = AnimatedProperty::kTranslation;
  std::vector<uint32_t> targets = {};
  uint32_t element = 0;
};

/// Reads the animations of one document.
class AnimationReader {
 public:
  AnimationReader(const GltfDocument& document, const std::vector<Node>& nodes, LoadReport& report)
      : document_(document), nodes_(nodes), report_(report) {}

  std::vector<Animation> read() {
    std::vector<Animation> animations;
    for (const json& source : elements_of(document_.json, "animations")) {
      place_ = "animations[" + std::to_string(animations.size()) + "]";
      Animation& animation = animations.emplace_back();
      // An animation that cannot be used is null (JsonCheck). It keeps its number.
      if (source.is_null() || source.empty()) continue;
      animation.name = to_utf8(source.value("name", ""));
      read_animation(source, animation);
    }
    return animations;
  }

 private:
  void read_animation(const json& source, Animation& animation) {
    samplers_.clear();
    changed_.clear();
    const json& channels = elements_of(source, "channels");
    for (size_t i = 0; i < channels.size(); ++i) {
      const std::string place = place_ + ".channels[" + std::to_string(i) + "]";
      // A channel that cannot be used has lost members (JsonCheck).
      if (channels[i].is_null() || !channels[i].contains("target") || !channels[i].contains("sampler")) continue;
      const std::optional<Target> target = find_target(channels[i]["target"], place + ".target");
      if (target) read_channel(elements_of(source, "samplers"), channels[i]["sampler"], *target, place, animation);
    }
    for (const AnimationSampler& sampler : animation.samplers) {
      animation.duration_s = std::max(animation.duration_s, sampler.times.back());
    }
  }

  void stand_still(ProblemCode code, const std::string& what, const std::string& place, const std::string& value = "") {
    report_.repair({code, what, value, place, kWriteAgain, kStandsStill});
  }

  // Targets of channels.

  std::optional<Target> find_target(const json& source, const std::string& place) {
    const std::string path = source["path"];
    if (const json* extension = find_extension(source, "KHR_animation_pointer")) {
      return find_pointer((*extension)["pointer"], place);
    }
    const auto node = source.find("node");
    // Readers ignore a channel without a node (section 3.11). It may have an extension.
    if (node == source.end()) return std::nullopt;
    for (const Pointer& pointer : kPointers) {
      const bool is_path = pointer.array == "/nodes/" && pointer.member == path;
      if (is_path) return check_node({pointer.property, {node->get<uint32_t>()}}, place);
    }
    stand_still("gltf.animation.target", "the path of an animation's target is unknown", place, quote(path));
    return std::nullopt;
  }

  std::optional<Target> find_pointer(const std::string& text, const std::string& place) {
    for (const Pointer& pointer : kPointers) {
      if (!text.starts_with(pointer.array)) continue;
      std::string_view rest = std::string_view(text).substr(pointer.array.size());
      const std::optional<uint32_t> index = take_number<uint32_t>(rest);
      if (!index || !rest.starts_with('/')) continue;
      rest.remove_prefix(1);
      if (!rest.starts_with(pointer.member)) continue;
      rest.remove_prefix(pointer.member.size());
      Target target{pointer.property, {*index}};
      if (pointer.property == AnimatedProperty::kWeight) {
        target.element = take_number<uint32_t>(rest).value_or(kNoIndex);
      }
      if (rest.empty()) return check_pointer(std::move(target), pointer.array, text, place);
    }
    if (std::optional<Target> target = find_texture(text)) {
      return check_pointer(std::move(*target), kMaterials, text, place);
    }
    report_.warn({"gltf.animation.pointer", "an animation changes a property that promin does not animate", quote(text),
                  place, "", kStandsStill});
    return std::nullopt;
  }

  /// Returns the part of a texture's transform that a pointer names.
  static std::optional<Target> find_texture(std::string_view text) {
    if (!drop_begin(text, kMaterials)) return std::nullopt;
    const std::optional<uint32_t> index = take_number<uint32_t>(text);
    if (!index || !drop_begin(text, "/")) return std::nullopt;
    for (uint32_t slot = 0; slot < std::size(kSlots); ++slot) {
      std::string_view rest = text;
      if (!drop_begin(rest, kSlots[slot].place) || !drop_begin(rest, kTransform)) continue;
      for (const auto& [name, property] : kTransformParts) {
        if (rest == name) return Target{property, {*index}, slot};
      }
    }
    return std::nullopt;
  }

  std::optional<Target> check_pointer(Target target, std::string_view array, const std::string& text,
                                      const std::string& place) {
    const uint32_t index = target.targets.front();
    if (index >= count_elements(array)) {
      stand_still("gltf.animation.target", "an animation's target does not exist", place, quote(text));
      return std::nullopt;
    }
    if (array == "/nodes/") return check_node(std::move(target), place);
    if (array == "/meshes/") {
      target.targets = find_nodes_of_mesh(index);
      if (target.targets.empty()) return std::nullopt;
      return check_node(std::move(target), place);
    }
    return target;
  }

  size_t count_elements(std::string_view array) const {
    if (array != kLights) {
      const std::string name(array.substr(1, array.size() - 2));
      return elements_of(document_.json, name.c_str()).size();
    }
    const json* extension = find_extension(document_.json, "KHR_lights_punctual");
    return extension == nullptr ? 0 : elements_of(*extension, "lights").size();
  }

  /// Returns the nodes that show a mesh with the mesh's weights.
  std::vector<uint32_t> find_nodes_of_mesh(uint32_t mesh) const {
    std::vector<uint32_t> found;
    for (uint32_t i = 0; i < document_.nodes.size(); ++i) {
      const GltfNode& node = document_.nodes[i];
      if (node.mesh == static_cast<int>(mesh) && !node.weights) found.push_back(i);
    }
    return found;
  }

  /// Returns nullopt if the nodes do not have the property.
  std::optional<Target> check_node(Target target, const std::string& place) {
    const Node& node = nodes_[target.targets.front()];
    const bool is_weight =
        target.property == AnimatedProperty::kWeights || target.property == AnimatedProperty::kWeight;
    if (is_weight && (node.weights.empty() || target.element >= std::max<size_t>(node.weights.size(), 1))) {
      stand_still("gltf.animation.target", "an animation changes weights of morph targets that do not exist", place);
      return std::nullopt;
    }
    if (!is_weight && target.property != AnimatedProperty::kVisibility && node.matrix) {
      stand_still("gltf.animation.matrix", "an animation moves a node that has a matrix", place);
      return std::nullopt;
    }
    return target;
  }

  // Samplers.

  void read_channel(const json& samplers, size_t sampler, const Target& target, const std::string& place,
                    Animation& animation) {
    const bool exists = sampler < samplers.size() && !samplers[sampler].is_null() && !samplers[sampler].empty();
    if (!exists) return stand_still("gltf.animation.sampler", "a sampler does not exist", place + ".sampler");
    const std::string sampler_place = place_ + ".samplers[" + std::to_string(sampler) + "]";
    const std::optional<uint32_t> index = find_sampler(samplers[sampler], sampler, target, sampler_place, animation);
    if (!index) return;
    for (const uint32_t node : target.targets) {
      if (!changed_.emplace(target.property, node, target.element).second) {
        stand_still("gltf.animation.twice", "two channels of an animation change the same property", place);
        continue;
      }
      animation.channels.push_back({*index, target.property, node, target.element});
    }
  }

  /// Returns the index of a sampler for values of this property. It is read once for each number of components.
  std::optional<uint32_t> find_sampler(const json& source, size_t number, const Target& target,
                                       const std::string& place, Animation& animation) {
    const auto [known, is_new] = samplers_.try_emplace({number, shape_of(target)});
    if (!is_new) return known->second;
    AnimationSampler sampler;
    sampler.interpolation = interpolation_of(source, target.property, place);
    const int input = source["input"];
    const int output = source["output"];
    if (!check_accessors(input, output, place)) return std::nullopt;
    sampler.times = read_doubles(document_, input, report_);
    if (!check_times(sampler.times, place)) return std::nullopt;
    const uint64_t wanted =
        shape_of(target).first * sampler.times.size() * numbers_per_component(sampler.interpolation);
    const GltfAccessor& values = document_.accessors[static_cast<size_t>(output)];
    const uint64_t existing = values.count * values.component_count;
    if (!check_counts(values, target, wanted, existing, place, animation)) return std::nullopt;
    number_count_ += wanted + sampler.times.size();
    if (number_count_ > kMaxNumbers) {
      report_.refuse("scene.size.limit", "the animations have more than " + std::to_string(kMaxNumbers) + " numbers",
                     place, "use fewer keys");
      return std::nullopt;
    }
    sampler.values = read_doubles(document_, output, report_);
    if (!check_values(sampler, target.property, place)) return std::nullopt;
    animation.samplers.push_back(std::move(sampler));
    return known->second = static_cast<uint32_t>(animation.samplers.size() - 1);
  }

  /// Returns the number of components of a value, and whether it is a rotation.
  std::pair<size_t, bool> shape_of(const Target& target) const {
    const size_t components = components_of(target.property);
    const size_t weights = nodes_.empty() || target_of(target.property) != AnimatedTarget::kNode
                               ? 0
                               : nodes_[target.targets.front()].weights.size();
    return {components == 0 ? weights : components, target.property == AnimatedProperty::kRotation};
  }

  Interpolation interpolation_of(const json& source, AnimatedProperty property, const std::string& place) {
    const std::string name = source.value("interpolation", "LINEAR");
    if (name == "STEP") return Interpolation::kStep;
    if (property == AnimatedProperty::kVisibility) {
      report_.repair({"gltf.animation.step", "an animation interpolates a visibility", "", place + ".interpolation",
                      "write STEP", "promin reads it as STEP"});
      return Interpolation::kStep;
    }
    return name == "CUBICSPLINE" ? Interpolation::kCubicSpline : Interpolation::kLinear;
  }

  bool check_accessors(int input, int output, const std::string& place) {
    const GltfAccessor& times = document_.accessors[static_cast<size_t>(input)];
    if (times.component_count != 1 || times.component_type != kGltfFloat) {
      stand_still("gltf.animation.format", "the times of an animation are not floats", place + ".input");
      return false;
    }
    if (has_accessor_bytes(document_, input) && has_accessor_bytes(document_, output)) return true;
    stand_still("gltf.animation.missing", "the numbers of an animation are missing", place);
    return false;
  }

  bool check_times(const std::vector<double>& times, const std::string& place) {
    const auto is_wrong = [](double before, double after) { return !(before < after); };
    const bool is_finite = std::ranges::all_of(times, [](double time) { return std::isfinite(time) && time >= 0.0; });
    if (times.empty() || !is_finite) {
      stand_still("gltf.animation.times", "the times of an animation are missing, negative or not finite",
                  place + ".input");
      return false;
    }
    const auto wrong = std::ranges::adjacent_find(times, is_wrong);
    if (wrong == times.end()) return true;
    stand_still("gltf.animation.order", "the keys of an animation are not in the order of time", place + ".input",
                "key " + std::to_string(wrong - times.begin() + 1));
    return false;
  }

  bool check_counts(const GltfAccessor& values, const Target& target, uint64_t wanted, uint64_t existing,
                    const std::string& place, Animation& animation) {
    // An accessor of scalars may have any number of components in a value.
    const size_t components = components_of(target.property);
    if (values.component_count != std::max<size_t>(components, 1)) {
      stand_still("gltf.animation.format", "the values of an animation have the wrong number of components",
                  place + ".output");
      return false;
    }
    if (existing == wanted) return true;
    const uint64_t size = std::max<uint64_t>(components, 1);
    std::string what = "an animation has ";
    what.append(count_of(existing / size, "value"))
        .append(", but its keys need ")
        .append(std::to_string(wanted / size));
    // A strict loader refuses the file. Otherwise only poses of the animation are refused.
    report_.repair({"gltf.animation.count", what, "", place + ".output", "give each key its values",
                    "promin refuses to show the animation"});
    animation.problems.push_back({"gltf.animation.count", what, report_.file().string() + ": " + place + ".output",
                                  "give each key its values, or choose another animation"});
    return false;
  }

  bool check_values(const AnimationSampler& sampler, AnimatedProperty property, const std::string& place) {
    if (!std::ranges::all_of(sampler.values, [](double value) { return std::isfinite(value); })) {
      stand_still("gltf.animation.values", "a value of an animation is not finite", place + ".output");
      return false;
    }
    if (property != AnimatedProperty::kRotation) return true;
    const size_t parts = numbers_per_component(sampler.interpolation);
    for (size_t key = 0; key < sampler.times.size(); ++key) {
      const double* q = &sampler.values[4 * (key * parts + parts / 2)];
      if (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] >= kLeastSquare) continue;
      stand_still("gltf.rotation.zero", "a rotation of an animation has length 0", place + ".output",
                  "key " + std::to_string(key));
      return false;
    }
    return true;
  }

  const GltfDocument& document_;
  const std::vector<Node>& nodes_;
  LoadReport& report_;
  /// The place of the current animation.
  std::string place_;
  /// The indices of the current animation's samplers, by number in the file and shape_of(); empty for wrong ones.
  std::map<std::pair<size_t, std::pair<size_t, bool>>, std::optional<uint32_t>> samplers_;
  /// The properties that the current animation changes.
  std::set<std::tuple<AnimatedProperty, uint32_t, uint32_t>> changed_;
  uint64_t number_count_ = 0;
};

}  // namespace

std::vector<Animation> read_gltf_animations(const GltfDocument& document, const std::vector<Node>& nodes,
                                            LoadReport& report) {
  return AnimationReader(document, nodes, report).read();
}

std::vector<TextureLink> read_gltf_texture_links(const json& material) {
  std::vector<TextureLink> links;
  for (const SlotPlace& slot : kSlots) {
    TextureLink& link = links.emplace_back();
    link.slot = slot.member;
    const json::json_pointer place(std::string("/").append(slot.place));
    if (!material.contains(place)) continue;
    const json* transform = find_extension(material.at(place), "KHR_texture_transform");
    if (transform == nullptr) continue;
    const json offset = transform->value("offset", json::array({0.0, 0.0}));
    const json scale = transform->value("scale", json::array({1.0, 1.0}));
    link.offset = {offset[0].get<double>(), offset[1].get<double>()};
    link.scale = {scale[0].get<double>(), scale[1].get<double>()};
    link.rotation = transform->value("rotation", 0.0);
  }
  return links;
}

GltfAnimated find_gltf_animated(const std::vector<Animation>& animations, const std::vector<Node>& nodes,
                                size_t material_count) {
  GltfAnimated animated;
  animated.is_moved.resize(nodes.size());
  animated.is_hidden.resize(nodes.size());
  animated.is_morphed.resize(nodes.size());
  animated.is_material_changed.resize(material_count);
  for (const Animation& animation : animations) {
    for (const AnimationChannel& channel : animation.channels) {
      const AnimatedTarget kind = target_of(channel.property);
      if (kind == AnimatedTarget::kMaterial) animated.is_material_changed[channel.target] = true;
      if (kind != AnimatedTarget::kNode) continue;
      const bool is_morph =
          channel.property == AnimatedProperty::kWeights || channel.property == AnimatedProperty::kWeight;
      (is_morph ? animated.is_morphed : animated.is_moved)[channel.target] = true;
      if (channel.property == AnimatedProperty::kVisibility) animated.is_hidden[channel.target] = true;
    }
  }
  for (const uint32_t i : order_nodes(nodes)) {
    const Node& node = nodes[i];
    if (node.same_as != kNoIndex) {
      // The flags of the other node may already contain those of its ancestors, which does no harm.
      animated.is_moved[i] = animated.is_moved[node.same_as];
      animated.is_hidden[i] = animated.is_hidden[node.same_as];
      animated.is_morphed[i] = animated.is_morphed[node.same_as];
    }
    if (node.parent == kNoIndex) continue;
    if (animated.is_moved[node.parent]) animated.is_moved[i] = true;
    if (animated.is_hidden[node.parent]) animated.is_hidden[i] = true;
  }
  return animated;
}

}  // namespace promin
