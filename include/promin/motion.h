// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "promin/error.h"
#include "promin/export.h"
#include "promin/math.h"
#include "promin/scene.h"

// The motion of a scene: the nodes, skins, morph targets and animations of its file (docs/model.md, "Motion"). A Scene
// always has one pose, and its Scene::motion describes how scene_at() gives it another pose.

namespace promin {

/// The value of an index in a Motion that refers to nothing.
inline constexpr uint32_t kNoIndex = std::numeric_limits<uint32_t>::max();

/// A transform as a translation after a rotation after a scale.
struct Trs {
  /// The translation.
  dvec3 translation{0.0};
  /// The rotation as a quaternion x, y, z, w of any length except 0; promin normalises it.
  dvec4 rotation{0.0, 0.0, 0.0, 1.0};
  /// The factors along the axes.
  dvec3 scale{1.0};
};

/// A node: a coordinate system in that of its parent.
struct Node {
  /// The display name; may be empty.
  std::string name = {};
  /// Index of the parent; kNoIndex for a root.
  uint32_t parent = kNoIndex;
  /// Index of a node whose transform, visibility and weights this node has at all times; kNoIndex if it has its own.
  /// This describes a node of the file that is shown below several parents.
  uint32_t same_as = kNoIndex;
  /// The transform to the parent.
  Trs trs = {};
  /// If set, the transform to the parent, affine. Then animations cannot change the transform.
  std::optional<dmat4> matrix = std::nullopt;
  /// False if the node hides itself and its descendants (KHR_node_visibility).
  bool is_visible = true;
  /// The weights of the morph targets of the node's mesh.
  std::vector<double> weights = {};
};

/// The joints that move meshes.
struct Skin {
  /// The display name; may be empty.
  std::string name;
  /// Indices of nodes.
  std::vector<uint32_t> joints;
  /// The transform from the mesh to each joint, affine; empty for identities.
  std::vector<dmat4> inverse_bind;
};

/// Displacements of the vertices of a mesh. Each list has one element for each vertex, or is empty.
struct MorphTarget {
  std::vector<vec3> positions;  ///< Displacements of the positions.
  std::vector<vec3> normals;    ///< Displacements of the normals.
  std::vector<vec3> tangents;   ///< Displacements of x, y and z of the tangents.
  std::vector<vec4> uvs;        ///< Displacements of the texture coordinates.
  std::vector<vec4> colors;     ///< Displacements of the colours.
};

/// The joints that move the vertices of a mesh, and their weights (glTF 2.0, section 3.7.3).
struct SkinInfluences {
  /// The number of joints per vertex; 0 if the mesh has none.
  size_t per_vertex = 0;
  /// Indices into Skin::joints: `per_vertex` for each vertex, one vertex after the other. An index is in range if its
  /// weight is not 0.
  std::vector<uint32_t> joints = {};
  /// The weight of each joint, finite. The sum of a vertex's weights is not 0.
  std::vector<float> weights = {};
};

/// A mesh that changes its form.
struct DeformingMesh {
  /// The mesh before all displacements, in its own space.
  Mesh base;
  /// The morph targets. Target i has the weight i of the node; missing weights are 0.
  std::vector<MorphTarget> targets;
  /// The joints of the vertices.
  SkinInfluences influences;
};

/// The kind of a thing that an animation changes.
enum class AnimatedTarget : uint32_t {
  /// A node, by its index in Motion::nodes.
  kNode,
  /// The lights with this LightLink::definition.
  kLight,
  /// The cameras with this CameraLink::definition.
  kCamera,
  /// A material, by its index in Scene::materials.
  kMaterial,
};

/// A property that animations change: kTranslation, kRotation, kBaseColor, ... (promin/kinds/animated.def).
enum class AnimatedProperty : uint32_t {
/// @cond
#define PROMIN_ANIMATED(ENUMERATOR, TARGET, COMPONENTS, NAME) ENUMERATOR,
#include "promin/kinds/animated.def"
  /// @endcond
};

/// The interpolation between two keys (glTF 2.0, appendix C).
enum class Interpolation : uint32_t {
  /// The value of the last key.
  kStep,
  /// Linear interpolation; for rotations, spherical linear interpolation along the shorter arc.
  kLinear,
  /// A cubic Hermite spline. Rotations are normalised.
  kCubicSpline,
};

/// A function of time, given by keys. Before the first key and after the last one it is constant.
struct AnimationSampler {
  /// The interpolation between keys.
  Interpolation interpolation = Interpolation::kLinear;
  /// The times of the keys in seconds, finite and strictly ascending. There is at least one.
  std::vector<double> times;
  /// The values of the keys, one after the other. For kCubicSpline, each key has an in-tangent, a value and an
  /// out-tangent.
  std::vector<double> values;
};

/// Connects a sampler with the property that it changes.
struct AnimationChannel {
  /// Index into Animation::samplers.
  uint32_t sampler = 0;
  /// The property.
  AnimatedProperty property = AnimatedProperty::kTranslation;
  /// The index of the target. The property determines its kind.
  uint32_t target = 0;
  /// For AnimatedProperty::kWeight, the index of the weight. For kTextureOffset, kTextureRotation and kTextureScale,
  /// the index into MaterialLink::textures.
  uint32_t element = 0;
};

/// A clip: changes of properties over time.
struct Animation {
  /// The display name; may be empty.
  std::string name = {};
  /// The time of the last key in seconds.
  double duration_s = 0.0;
  /// The functions of time.
  std::vector<AnimationSampler> samplers = {};
  /// The properties that they change.
  std::vector<AnimationChannel> channels = {};
  /// Problems because of which promin refuses to show the animation.
  std::vector<Problem> problems = {};
};

/// The connection of an object with nodes and geometries.
struct ObjectLink {
  /// Index of the node that places the object; kNoIndex if the object rests, so that no other member has an effect. The
  /// joints of `skin` place a skinned mesh instead.
  uint32_t node = kNoIndex;
  /// Index into Scene::geometries: the geometry when it is shown; kNoIndex if there is none or `mesh` is given.
  uint32_t geometry = kNoIndex;
  /// Index into Scene::geometries: the mesh that replaces an analytic shape which the transform distorts.
  uint32_t fallback = kNoIndex;
  /// Index into Motion::meshes: the mesh that is deformed for each pose.
  uint32_t mesh = kNoIndex;
  /// Index into Motion::skins; kNoIndex for a mesh without a skin.
  uint32_t skin = kNoIndex;
  /// Index into Motion::places: the transform from the object to its node; kNoIndex for the identity.
  uint32_t place = kNoIndex;
};

/// The connection of a light with its node, and the factors of its power.
struct LightLink {
  /// Index of the node that places the light.
  uint32_t node = kNoIndex;
  /// The number by which channels name the light. Several lights may share it.
  uint32_t definition = kNoIndex;
  /// The light without animations. It counts if an animation changes the light.
  Light rest = {};
  /// The colour, a factor of the power.
  dvec3 color{1.0};
  /// The intensity, a factor of the power.
  double intensity = 1.0;
  /// True if the diffuse power is the product of colour and intensity.
  bool has_diffuse_power = true;
  /// The same for the specular power.
  bool has_specular_power = true;
};

/// The connection of a camera with its node.
struct CameraLink {
  /// Index of the node that places the camera.
  uint32_t node = kNoIndex;
  /// The number by which channels name the camera. Several cameras may share it.
  uint32_t definition = kNoIndex;
  /// The camera without animations. It counts if an animation changes the camera.
  Camera rest = {};
  /// Half the width of an orthographic camera's view.
  double xmag = 1.0;
};

/// The transform of the texture coordinates of a slot: they are scaled, then rotated, then moved
/// (KHR_texture_transform).
struct TextureLink {
  /// The name of the member of the material or of its model, such as "base_color_texture".
  std::string slot;
  /// The translation.
  dvec2 offset{0.0};
  /// The rotation in radians.
  double rotation = 0.0;
  /// The factors.
  dvec2 scale{1.0};
};

/// A material that animations change.
struct MaterialLink {
  /// Index into Scene::materials.
  uint32_t material = 0;
  /// The material without animations.
  Material rest = {};
  /// The factor of the emission.
  dvec3 emissive{0.0};
  /// The strength of the emission, another factor (KHR_materials_emissive_strength).
  double emissive_strength = 1.0;
  /// The transforms of texture coordinates that animations may change, without animations. Transforms of slots that the
  /// material does not have count for nothing.
  std::vector<TextureLink> textures = {};
};

/// Everything that a scene needs for other poses. Scenes share it, because it may be large. pose_of() and scene_at()
/// check its indices and counts.
struct Motion {
  /// The nodes. For a glTF file, node i is the file's node i. Further nodes follow for nodes with several parents.
  std::vector<Node> nodes;
  /// The skins.
  std::vector<Skin> skins;
  /// The meshes that change their form, never null.
  std::vector<std::shared_ptr<const DeformingMesh>> meshes;
  /// The animations.
  std::vector<Animation> animations;
  /// Transforms of instances (ObjectLink::place).
  std::vector<dmat4> places;
  /// The link of each object of the scene. Objects without a link rest. A loader gives no links to objects that no
  /// animation can change.
  std::vector<ObjectLink> objects;
  /// The link of each light. Lights without a link rest.
  std::vector<LightLink> lights;
  /// The link of each camera. Cameras without a link rest.
  std::vector<CameraLink> cameras;
  /// The materials that animations change. Animations do not change others.
  std::vector<MaterialLink> materials;
};

/// The choice of a pose.
struct PoseChoice {
  /// Indices of animations, which are shown together. If several change the same property, the lowest index counts. If
  /// there are none, the pose is that of the nodes.
  std::vector<uint32_t> animations;
  /// The time in seconds, finite.
  double time_s = 0.0;
  /// If true, each animation starts again after its duration. Otherwise it stops at its ends.
  bool loops = false;
};

/// The state of all nodes at one time.
struct Pose {
  /// The nodes with their transforms, visibilities and weights at this time.
  std::vector<Node> nodes;
  /// The transform of each node to the scene. Extreme numbers may overflow.
  std::vector<dmat4> world_from_node;
  /// True if the node and its ancestors are visible.
  std::vector<bool> is_visible;
  /// The values of animated properties of lights, cameras and materials.
  struct Value {
    AnimatedProperty property = AnimatedProperty::kLightColor;  ///< The property.
    uint32_t target = 0;                                        ///< The index of its target.
    dvec4 value{0.0};                                           ///< Its components; the others are 0.
    uint32_t element = 0;                                       ///< AnimationChannel::element.
  };
  /// These values, in the order of the channels.
  std::vector<Value> values;
  /// Remarks, such as animations that change the same property. Each warning is one sentence.
  std::vector<std::string> warnings;
};

/// Returns the state of the scene's nodes. All numbers are computed in double, and do not depend on the processor.
/// Throws InputError if Scene::motion is invalid or missing, if the time is not finite, or if an animation does not
/// exist or has problems.
PROMIN_EXPORT Pose pose_of(const Scene& scene, const PoseChoice& choice = {});

/// Returns the scene in another pose. Objects, lights, cameras and materials keep their numbers, and those without
/// motion keep their bits. Objects that a pose hides or reduces to nothing have no geometry. The pose of `scene` has no
/// effect. A scene without motion is returned unchanged. Throws the same errors as pose_of(), and InputError if a
/// transform overflows or a vertex moves beyond 1e15.
PROMIN_EXPORT Scene scene_at(Scene scene, const PoseChoice& choice);

/// Returns the kind of target of a property.
PROMIN_EXPORT AnimatedTarget target_of(AnimatedProperty property);
/// Returns the number of components of a property; 0 for AnimatedProperty::kWeights.
PROMIN_EXPORT uint32_t components_of(AnimatedProperty property);
/// Returns the display name of a property.
PROMIN_EXPORT std::string_view name_of(AnimatedProperty property);

}  // namespace promin
