// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/schema.h"

#include <algorithm>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <span>

#include "formats/gltf/json_rule.h"
#include "promin/validate.h"

namespace promin {
namespace {

using namespace rules;
using nlohmann::json;

/// Returns the rule for a length: fp32 must be able to store its square.
constexpr JsonRule length(std::string_view path) {
  return number(path, kMinSize, kMaxCoordinate);
}
constexpr JsonRule length_or_zero(std::string_view path) {
  return number(path, 0.0, kMaxCoordinate);
}
/// Returns the rule for a factor that divides light: a number in 0...1.
constexpr JsonRule share(std::string_view path) {
  return number(path, 0.0, 1.0);
}
constexpr JsonRule shares(std::string_view path, size_t count) {
  return numbers(path, count, 0.0, 1.0);
}
/// Returns the rule for powers and factors of light, which are not negative but may exceed 1.
constexpr JsonRule factor(std::string_view path) {
  return number(path, 0.0, kMaxCoordinate);
}
constexpr JsonRule color(std::string_view path) {
  return numbers(path, 3, 0.0, kMaxCoordinate);
}

constexpr double kMaxBytes = 0x1p53;
constexpr double kMaxCount = 0x1p31 - 1.0;
constexpr double kMaxScalar = 1e30;
constexpr double kMaxFloat = 3.4028234663852886e38;
/// Pi/2 as some exporters write it: their fp32 value is a little too large.
constexpr double kHalfPi = 1.5707964;
constexpr double kPi = 3.141592653589793;
constexpr double kJustUnder = 1.0 - 0x1p-52;
constexpr double kTiny = 1e-9;
/// The smallest side of a light, and its smallest ratio of width to height.
constexpr double kMinSide = 1e-15;
constexpr double kMinAspect = 1e-6;

#define PROMIN_LIGHTS "extensions.KHR_lights_punctual.lights"
#define PROMIN_AREAS "extensions.EXT_lights_area.lights"
#define PROMIN_SHAPES "extensions.KHR_implicit_shapes.shapes"
#define PROMIN_SKIES "extensions.OMI_environment_sky.skies"
#define PROMIN_LINK "meshes[].primitives[].extensions.PROMIN_mesh_primitive_implicit_shape"
#define PROMIN_COAT "materials[].extensions.KHR_materials_clearcoat"
#define PROMIN_SHEEN "materials[].extensions.KHR_materials_sheen"
#define PROMIN_FILM "materials[].extensions.KHR_materials_iridescence"
#define PROMIN_ANISOTROPY "materials[].extensions.KHR_materials_anisotropy"
#define PROMIN_DIFFUSE_TRANSMISSION "materials[].extensions.KHR_materials_diffuse_transmission"
#define PROMIN_TRANSMISSION "materials[].extensions.KHR_materials_transmission"
#define PROMIN_VOLUME "materials[].extensions.KHR_materials_volume"
#define PROMIN_SPECULAR "materials[].extensions.KHR_materials_specular"
#define PROMIN_PHONG "materials[].extensions.PROMIN_materials_phong"
#define PROMIN_GLOSSY "materials[].extensions.KHR_materials_pbrSpecularGlossiness"
#define PROMIN_VARIANTS "extensions.KHR_materials_variants.variants"
#define PROMIN_MAPPINGS "meshes[].primitives[].extensions.KHR_materials_variants.mappings"
#define PROMIN_DRACO "meshes[].primitives[].extensions.KHR_draco_mesh_compression"
#define PROMIN_INSTANCES "nodes[].extensions.EXT_mesh_gpu_instancing.attributes"

#define PROMIN_TEXTURE_INFO(PATH)                                                                  \
  object(PATH), needed(index(PATH ".index", "textures")), integer(PATH ".texCoord", 0, kMaxCount), \
      object(PATH ".extensions"), object(PATH ".extensions.*"),                                    \
      numbers(PATH ".extensions.KHR_texture_transform.offset", 2, -kMaxScalar, kMaxScalar),        \
      numbers(PATH ".extensions.KHR_texture_transform.scale", 2, -kMaxScalar, kMaxScalar),         \
      number(PATH ".extensions.KHR_texture_transform.rotation", -kMaxScalar, kMaxScalar),          \
      integer(PATH ".extensions.KHR_texture_transform.texCoord", 0, kMaxCount)

#define PROMIN_MESHOPT(PATH)                                                                                      \
  object(PATH), needed(index(PATH ".buffer", "buffers")), integer(PATH ".byteOffset", 0, kMaxBytes),              \
      needed(integer(PATH ".byteLength", 1, kMaxBytes)), needed(integer(PATH ".byteStride", 1, 256)),             \
      needed(integer(PATH ".count", 1, kMaxCount)), needed(choice(PATH ".mode", "ATTRIBUTES|TRIANGLES|INDICES")), \
      choice(PATH ".filter", "NONE|OCTAHEDRAL|QUATERNION|EXPONENTIAL")

constexpr JsonRule kRules[] = {
    array("extensionsUsed"),
    leaving_out("extensionsUsed", text("extensionsUsed[]")),
    array("extensionsRequired"),
    leaving_out("extensionsRequired", text("extensionsRequired[]")),

    array("scenes"),
    index("scene", "scenes"),
    object("scenes[]"),
    array("scenes[].nodes"),
    index("scenes[].nodes[]", "nodes"),

    array("nodes"),
    object("nodes[]"),
    text("nodes[].name"),
    array("nodes[].children"),
    index("nodes[].children[]", "nodes"),
    index("nodes[].mesh", "meshes"),
    index("nodes[].camera", "cameras"),
    index("nodes[].skin", "skins"),
    numbers("nodes[].matrix", 16, -kMaxScalar, kMaxScalar),
    numbers("nodes[].translation", 3, -kMaxCoordinate, kMaxCoordinate),
    numbers("nodes[].rotation", 4, -kMaxScalar, kMaxScalar),
    numbers("nodes[].scale", 3, -kMaxScalar, kMaxScalar),
    array("nodes[].weights"),
    number("nodes[].weights[]", -kMaxScalar, kMaxScalar),

    array("meshes"),
    object("meshes[]"),
    text("meshes[].name"),
    needed(array("meshes[].primitives")),
    object("meshes[].primitives[]"),
    needed(object("meshes[].primitives[].attributes")),
    index("meshes[].primitives[].attributes.*", "accessors"),
    index("meshes[].primitives[].indices", "accessors"),
    index("meshes[].primitives[].material", "materials"),
    integer("meshes[].primitives[].mode", 0, 6),
    array("meshes[].primitives[].targets"),
    object("meshes[].primitives[].targets[]"),
    index("meshes[].primitives[].targets[].*", "accessors"),
    array("meshes[].weights"),
    number("meshes[].weights[]", -kMaxScalar, kMaxScalar),

    array("skins"),
    object("skins[]"),
    text("skins[].name"),
    array("skins[].joints"),
    index("skins[].joints[]", "nodes"),
    index("skins[].inverseBindMatrices", "accessors"),

    array("animations"),
    object("animations[]"),
    text("animations[].name"),
    needed(array("animations[].samplers")),
    object("animations[].samplers[]"),
    needed(index("animations[].samplers[].input", "accessors")),
    needed(index("animations[].samplers[].output", "accessors")),
    choice("animations[].samplers[].interpolation", "LINEAR|STEP|CUBICSPLINE"),
    needed(array("animations[].channels")),
    object("animations[].channels[]"),
    needed(integer("animations[].channels[].sampler", 0, kMaxCount)),
    needed(object("animations[].channels[].target")),
    index("animations[].channels[].target.node", "nodes"),
    needed(text("animations[].channels[].target.path")),
    object("animations[].channels[].target.extensions"),
    object("animations[].channels[].target.extensions.*"),
    needed(text("animations[].channels[].target.extensions.KHR_animation_pointer.pointer")),

    array("materials"),
    object("materials[]"),
    text("materials[].name"),
    object("materials[].pbrMetallicRoughness"),
    shares("materials[].pbrMetallicRoughness.baseColorFactor", 4),
    share("materials[].pbrMetallicRoughness.metallicFactor"),
    share("materials[].pbrMetallicRoughness.roughnessFactor"),
    color("materials[].emissiveFactor"),
    PROMIN_TEXTURE_INFO("materials[].pbrMetallicRoughness.baseColorTexture"),
    PROMIN_TEXTURE_INFO("materials[].pbrMetallicRoughness.metallicRoughnessTexture"),
    PROMIN_TEXTURE_INFO("materials[].normalTexture"),
    number("materials[].normalTexture.scale", -kMaxScalar, kMaxScalar),
    PROMIN_TEXTURE_INFO("materials[].occlusionTexture"),
    share("materials[].occlusionTexture.strength"),
    PROMIN_TEXTURE_INFO("materials[].emissiveTexture"),
    choice("materials[].alphaMode", "OPAQUE|MASK|BLEND"),
    number("materials[].alphaCutoff", 0.0, kMaxScalar),
    boolean("materials[].doubleSided"),
    object("materials[].extensions"),
    object("materials[].extensions.*"),
    factor("materials[].extensions.KHR_materials_emissive_strength.emissiveStrength"),
    unclamped(number("materials[].extensions.KHR_materials_ior.ior", 0.0, kMaxScalar)),
    share(PROMIN_TRANSMISSION ".transmissionFactor"),
    PROMIN_TEXTURE_INFO(PROMIN_TRANSMISSION ".transmissionTexture"),
    factor(PROMIN_VOLUME ".thicknessFactor"),
    unclamped(number(PROMIN_VOLUME ".attenuationDistance", 1e-30, kMaxFloat)),
    shares(PROMIN_VOLUME ".attenuationColor", 3),
    factor("materials[].extensions.KHR_materials_dispersion.dispersion"),
    share(PROMIN_SPECULAR ".specularFactor"),
    color(PROMIN_SPECULAR ".specularColorFactor"),
    PROMIN_TEXTURE_INFO(PROMIN_SPECULAR ".specularTexture"),
    PROMIN_TEXTURE_INFO(PROMIN_SPECULAR ".specularColorTexture"),
    share(PROMIN_DIFFUSE_TRANSMISSION ".diffuseTransmissionFactor"),
    shares(PROMIN_DIFFUSE_TRANSMISSION ".diffuseTransmissionColorFactor", 3),
    PROMIN_TEXTURE_INFO(PROMIN_DIFFUSE_TRANSMISSION ".diffuseTransmissionTexture"),
    PROMIN_TEXTURE_INFO(PROMIN_DIFFUSE_TRANSMISSION ".diffuseTransmissionColorTexture"),
    share(PROMIN_FILM ".iridescenceFactor"),
    unclamped(number(PROMIN_FILM ".iridescenceIor", 1.0, kMaxScalar)),
    number(PROMIN_FILM ".iridescenceThicknessMinimum", 0.0, kMaxScalar),
    number(PROMIN_FILM ".iridescenceThicknessMaximum", 0.0, kMaxScalar),
    PROMIN_TEXTURE_INFO(PROMIN_FILM ".iridescenceTexture"),
    PROMIN_TEXTURE_INFO(PROMIN_FILM ".iridescenceThicknessTexture"),
    share(PROMIN_ANISOTROPY ".anisotropyStrength"),
    number(PROMIN_ANISOTROPY ".anisotropyRotation", -kMaxScalar, kMaxScalar),
    PROMIN_TEXTURE_INFO(PROMIN_ANISOTROPY ".anisotropyTexture"),
    shares(PROMIN_SHEEN ".sheenColorFactor", 3),
    share(PROMIN_SHEEN ".sheenRoughnessFactor"),
    PROMIN_TEXTURE_INFO(PROMIN_SHEEN ".sheenColorTexture"),
    PROMIN_TEXTURE_INFO(PROMIN_SHEEN ".sheenRoughnessTexture"),
    share(PROMIN_COAT ".clearcoatFactor"),
    share(PROMIN_COAT ".clearcoatRoughnessFactor"),
    PROMIN_TEXTURE_INFO(PROMIN_COAT ".clearcoatTexture"),
    PROMIN_TEXTURE_INFO(PROMIN_COAT ".clearcoatRoughnessTexture"),
    PROMIN_TEXTURE_INFO(PROMIN_COAT ".clearcoatNormalTexture"),
    number(PROMIN_COAT ".clearcoatNormalTexture.scale", -kMaxScalar, kMaxScalar),
    shares(PROMIN_GLOSSY ".diffuseFactor", 4),
    shares(PROMIN_GLOSSY ".specularFactor", 3),
    share(PROMIN_GLOSSY ".glossinessFactor"),
    PROMIN_TEXTURE_INFO(PROMIN_GLOSSY ".diffuseTexture"),
    PROMIN_TEXTURE_INFO(PROMIN_GLOSSY ".specularGlossinessTexture"),
    color(PROMIN_PHONG ".ambientFactor"),
    color(PROMIN_PHONG ".diffuseFactor"),
    color(PROMIN_PHONG ".specularFactor"),
    color(PROMIN_PHONG ".reflectionFactor"),
    factor(PROMIN_PHONG ".shininess"),
    color(PROMIN_PHONG ".transmissionFactor"),
    unclamped(number(PROMIN_PHONG ".ior", kTiny, kMaxCoordinate)),
    boolean(PROMIN_PHONG ".fresnel"),

    array("images"),
    object("images[]"),
    text("images[].name"),
    text("images[].uri"),
    index("images[].bufferView", "bufferViews"),
    array("textures"),
    object("textures[]"),
    index("textures[].source", "images"),
    index("textures[].sampler", "samplers"),
    object("textures[].extensions"),
    object("textures[].extensions.*"),
    index("textures[].extensions.EXT_texture_avif.source", "images"),
    index("textures[].extensions.EXT_texture_webp.source", "images"),
    index("textures[].extensions.KHR_texture_basisu.source", "images"),
    array("samplers"),
    object("samplers[]"),
    choice("samplers[].magFilter", "9728|9729"),
    choice("samplers[].minFilter", "9728|9729|9984|9985|9986|9987"),
    choice("samplers[].wrapS", "33071|33648|10497"),
    choice("samplers[].wrapT", "33071|33648|10497"),

    array("cameras"),
    object("cameras[]"),
    text("cameras[].name"),
    needed(choice("cameras[].type", "perspective|orthographic")),
    object("cameras[].perspective"),
    leaving_out("cameras[]", needed(unclamped(number("cameras[].perspective.yfov", kTiny, kPi* kJustUnder)))),
    unclamped(number("cameras[].perspective.aspectRatio", kTiny, 1e9)),
    unclamped(length_or_zero("cameras[].perspective.znear")),
    object("cameras[].orthographic"),
    leaving_out("cameras[]", needed(unclamped(length("cameras[].orthographic.xmag")))),
    leaving_out("cameras[]", needed(unclamped(length("cameras[].orthographic.ymag")))),
    unclamped(length_or_zero("cameras[].orthographic.znear")),

    object("extensions"),
    object("extensions.*"),
    object("scenes[].extensions"),
    object("scenes[].extensions.*"),
    object("nodes[].extensions"),
    object("nodes[].extensions.*"),
    object("meshes[].primitives[].extensions"),
    object("meshes[].primitives[].extensions.*"),

    needed(index(PROMIN_DRACO ".bufferView", "bufferViews")),
    needed(object(PROMIN_DRACO ".attributes")),
    integer(PROMIN_DRACO ".attributes.*", 0, kMaxCount),

    needed(array(PROMIN_VARIANTS)),
    object(PROMIN_VARIANTS "[]"),
    needed(text(PROMIN_VARIANTS "[].name")),
    needed(array(PROMIN_MAPPINGS)),
    object(PROMIN_MAPPINGS "[]"),
    needed(index(PROMIN_MAPPINGS "[].material", "materials")),
    needed(array(PROMIN_MAPPINGS "[].variants")),
    leaving_out(PROMIN_MAPPINGS "[]", index(PROMIN_MAPPINGS "[].variants[]", PROMIN_VARIANTS)),

    needed(object(PROMIN_INSTANCES)),
    index(PROMIN_INSTANCES ".*", "accessors"),

    needed(index("nodes[].extensions.KHR_lights_punctual.light", PROMIN_LIGHTS)),
    boolean("nodes[].extensions.KHR_node_visibility.visible"),
    needed(array(PROMIN_LIGHTS)),
    object(PROMIN_LIGHTS "[]"),
    text(PROMIN_LIGHTS "[].name"),
    needed(choice(PROMIN_LIGHTS "[].type", "point|directional|spot")),
    color(PROMIN_LIGHTS "[].color"),
    factor(PROMIN_LIGHTS "[].intensity"),
    unclamped(number(PROMIN_LIGHTS "[].range", kMinSize, kMaxFloat)),
    object(PROMIN_LIGHTS "[].spot"),
    number(PROMIN_LIGHTS "[].spot.innerConeAngle", 0.0, kHalfPi),
    number(PROMIN_LIGHTS "[].spot.outerConeAngle", 0.0, kHalfPi),
    object(PROMIN_LIGHTS "[].extensions"),
    object(PROMIN_LIGHTS "[].extensions.PROMIN_lights_phong"),
    choice(PROMIN_LIGHTS "[].extensions.PROMIN_lights_phong.attenuation", "none|inverse_square"),
    color(PROMIN_LIGHTS "[].extensions.PROMIN_lights_phong.diffuseColor"),
    color(PROMIN_LIGHTS "[].extensions.PROMIN_lights_phong.specularColor"),
    object(PROMIN_LIGHTS "[].extensions.PROMIN_lights_size"),
    length_or_zero(PROMIN_LIGHTS "[].extensions.PROMIN_lights_size.radius"),
    number(PROMIN_LIGHTS "[].extensions.PROMIN_lights_size.angle", 0.0, kPi),

    needed(index("nodes[].extensions.EXT_lights_area.light", PROMIN_AREAS)),
    needed(array(PROMIN_AREAS)),
    object(PROMIN_AREAS "[]"),
    text(PROMIN_AREAS "[].name"),
    needed(choice(PROMIN_AREAS "[].type", "rect|disk")),
    color(PROMIN_AREAS "[].color"),
    factor(PROMIN_AREAS "[].intensity"),
    number(PROMIN_AREAS "[].size", kMinSide, kMaxCoordinate),
    object(PROMIN_AREAS "[].rect"),
    number(PROMIN_AREAS "[].rect.aspect", kMinAspect, 1.0 / kMinAspect),

    index("scenes[].extensions.OMI_environment_sky.sky", PROMIN_SKIES),
    needed(array(PROMIN_SKIES)),
    object(PROMIN_SKIES "[]"),
    needed(text(PROMIN_SKIES "[].type")),
    object(PROMIN_SKIES "[].plain"),
    color(PROMIN_SKIES "[].plain.color"),
    color(PROMIN_SKIES "[].ambientLightColor"),
    share(PROMIN_SKIES "[].ambientSkyContribution"),
    object(PROMIN_SKIES "[].gradient"),
    needed(color(PROMIN_SKIES "[].gradient.topColor")),
    needed(color(PROMIN_SKIES "[].gradient.horizonColor")),
    needed(color(PROMIN_SKIES "[].gradient.bottomColor")),
    unclamped(number(PROMIN_SKIES "[].gradient.topCurve", kTiny, kMaxScalar)),
    unclamped(number(PROMIN_SKIES "[].gradient.bottomCurve", kTiny, kMaxScalar)),
    object(PROMIN_SKIES "[].panorama"),
    index(PROMIN_SKIES "[].panorama.equirectangular", "textures"),

    needed(index(PROMIN_LINK ".shape", PROMIN_SHAPES)),
    needed(array(PROMIN_SHAPES)),
    object(PROMIN_SHAPES "[]"),
    text(PROMIN_SHAPES "[].name"),
    needed(choice(PROMIN_SHAPES "[].type", "sphere|box|capsule|cylinder|plane")),
    object(PROMIN_SHAPES "[].sphere"),
    length(PROMIN_SHAPES "[].sphere.radius"),
    object(PROMIN_SHAPES "[].box"),
    numbers(PROMIN_SHAPES "[].box.size", 3, kMinSize, kMaxCoordinate),
    object(PROMIN_SHAPES "[].capsule"),
    length_or_zero(PROMIN_SHAPES "[].capsule.height"),
    length_or_zero(PROMIN_SHAPES "[].capsule.radiusTop"),
    length_or_zero(PROMIN_SHAPES "[].capsule.radiusBottom"),
    object(PROMIN_SHAPES "[].cylinder"),
    length(PROMIN_SHAPES "[].cylinder.height"),
    length_or_zero(PROMIN_SHAPES "[].cylinder.radiusTop"),
    length_or_zero(PROMIN_SHAPES "[].cylinder.radiusBottom"),
    object(PROMIN_SHAPES "[].plane"),
};

constexpr JsonRule kAccessorRules[] = {
    array("accessors"),
    object("accessors[]"),
    index("accessors[].bufferView", "bufferViews"),
    integer("accessors[].byteOffset", 0, kMaxBytes),
    needed(choice("accessors[].componentType", "5120|5121|5122|5123|5125|5126")),
    boolean("accessors[].normalized"),
    needed(integer("accessors[].count", 0, kMaxCount)),
    needed(choice("accessors[].type", "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4")),
    object("accessors[].extensions"),
    object("accessors[].extensions.*"),
    object("accessors[].sparse"),
    needed(integer("accessors[].sparse.count", 0, kMaxCount)),
    needed(object("accessors[].sparse.indices")),
    needed(index("accessors[].sparse.indices.bufferView", "bufferViews")),
    integer("accessors[].sparse.indices.byteOffset", 0, kMaxCount),
    needed(choice("accessors[].sparse.indices.componentType", "5121|5123|5125")),
    needed(object("accessors[].sparse.values")),
    needed(index("accessors[].sparse.values.bufferView", "bufferViews")),
    integer("accessors[].sparse.values.byteOffset", 0, kMaxCount),
};

constexpr JsonRule kViewRules[] = {
    array("bufferViews"),
    object("bufferViews[]"),
    needed(index("bufferViews[].buffer", "buffers")),
    integer("bufferViews[].byteOffset", 0, kMaxBytes),
    needed(integer("bufferViews[].byteLength", 0, kMaxBytes)),
    integer("bufferViews[].byteStride", 0, kMaxCount),
    object("bufferViews[].extensions"),
    object("bufferViews[].extensions.*"),
    PROMIN_MESHOPT("bufferViews[].extensions.EXT_meshopt_compression"),
    PROMIN_MESHOPT("bufferViews[].extensions.KHR_meshopt_compression"),
};

constexpr JsonRule kBufferRules[] = {
    array("buffers"),
    object("buffers[]"),
    text("buffers[].uri"),
    needed(integer("buffers[].byteLength", 0, kMaxBytes)),
    object("buffers[].extensions"),
    object("buffers[].extensions.*"),
};

#undef PROMIN_LIGHTS
#undef PROMIN_AREAS
#undef PROMIN_SHAPES
#undef PROMIN_SKIES
#undef PROMIN_LINK
#undef PROMIN_COAT
#undef PROMIN_SHEEN
#undef PROMIN_FILM
#undef PROMIN_ANISOTROPY
#undef PROMIN_DIFFUSE_TRANSMISSION
#undef PROMIN_TRANSMISSION
#undef PROMIN_VOLUME
#undef PROMIN_SPECULAR
#undef PROMIN_PHONG
#undef PROMIN_GLOSSY
#undef PROMIN_VARIANTS
#undef PROMIN_MAPPINGS
#undef PROMIN_INSTANCES
#undef PROMIN_TEXTURE_INFO
#undef PROMIN_MESHOPT
#undef PROMIN_DRACO

/// The parts of a document that affect only colours, cameras and lights, and not the geometry.
constexpr std::string_view kRepairedParts[] = {
    "extensionsUsed",
    "extensionsRequired",
    "scene",
    "materials",
    "textures",
    "samplers",
    "images",
    "animations",
    "cameras",
    "nodes[].camera",
    "nodes[].extensions.KHR_lights_punctual",
    "nodes[].extensions.EXT_lights_area",
    "nodes[].extensions.KHR_node_visibility",
    "meshes[].primitives[].material",
    "meshes[].primitives[].extensions.KHR_materials_variants",
    "extensions.KHR_lights_punctual",
    "extensions.EXT_lights_area",
    "extensions.KHR_materials_variants",
    "extensions.OMI_environment_sky",
    "scenes[].extensions.OMI_environment_sky",
};

bool is_repaired(std::string_view path) {
  if (path.ends_with(".name")) return true;
  return std::ranges::any_of(kRepairedParts, [&](std::string_view part) {
    return path.starts_with(part) &&
           (path.size() == part.size() || path[part.size()] == '.' || path[part.size()] == '[');
  });
}

/// Removes the elements of an array that are unused and satisfy the condition.
template <class IsDropped>
void drop_unused(json& document, const char* name, const JsonCheck& check, const IsDropped& is_dropped) {
  const auto array = document.find(name);
  if (array == document.end() || !array->is_array()) return;
  for (size_t i = 0; i < array->size(); ++i) {
    if (!check.is_used(name, i) && is_dropped((*array)[i])) (*array)[i] = nullptr;
  }
}

/// Returns whether the URI of a buffer is unusable. The reader also requests the bytes of unused buffers.
bool is_broken_buffer(const json& buffer) {
  if (!buffer.is_object()) return true;
  const auto length = buffer.find("byteLength");
  const auto uri = buffer.find("uri");
  return length == buffer.end() || !length->is_number_unsigned() || (uri != buffer.end() && !uri->is_string());
}

bool is_of_gltf_1(const json& document) {
  return std::ranges::any_of(std::initializer_list<const char*>{"scenes", "nodes", "meshes"}, [&](const char* name) {
    const auto array = document.find(name);
    return array != document.end() && array->is_object();
  });
}

}  // namespace

void check_gltf_version(json& document, LoadReport& report) {
  if (!document.is_object()) {
    report.refuse("json.type", "the file is not a JSON object", "the top level", "export the file again");
    return;
  }
  json& asset = document["asset"];
  if (!asset.is_object()) asset = json::object();
  const auto given = asset.find("version");
  const std::string version = given == asset.end() ? ""
                              : given->is_string() ? given->get<std::string>()
                                                   : given->dump();
  if (version.starts_with("1") || (version.empty() && is_of_gltf_1(document))) {
    report.refuse("gltf.version", "the file is glTF 1.0, which promin does not read", "asset.version",
                  "export it as glTF 2.0");
  } else if (version.empty()) {
    report.repair({"gltf.version", "the version is missing", "", "asset.version", "write \"2.0\"",
                   "promin reads the file as glTF 2.0"});
  } else if (version != "2" && !version.starts_with("2.")) {
    report.refuse("gltf.version", "glTF version " + quote(version) + " is not 2.x", "asset.version",
                  "export the file as glTF 2.0");
  } else if (!given->is_string() || version == "2") {
    report.repair({"gltf.version", "the version does not have the form that glTF requires", version, "asset.version",
                   "write \"2.0\"", "promin reads the file as glTF 2.0"});
  }
  const auto least = asset.find("minVersion");
  if (least != asset.end() && *least != "2.0") {
    report.refuse("gltf.version",
                  "the file requires glTF " + quote(least->is_string() ? least->get<std::string>() : least->dump()),
                  "asset.minVersion", "export it for glTF 2.0");
  }
}

void check_gltf_schema(json& document, bool is_strict, LoadReport& report) {
  JsonCheck check(document, is_strict, report);
  const auto check_all = [&](std::span<const JsonRule> rules, std::string_view only_used) {
    for (JsonRule rule : rules) {
      rule.is_repaired = is_repaired(rule.path);
      check.check(rule, is_strict ? "" : only_used);
    }
  };
  check_all(kRules, "");
  check_all(kAccessorRules, "accessors");
  check_all(kViewRules, "bufferViews");
  check_all(kBufferRules, "buffers");
  if (is_strict) return;
  const auto is_any = [](const json&) { return true; };
  drop_unused(document, "accessors", check, is_any);
  drop_unused(document, "bufferViews", check, is_any);
  drop_unused(document, "buffers", check, is_broken_buffer);
}

}  // namespace promin
