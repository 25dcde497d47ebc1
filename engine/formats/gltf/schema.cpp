// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/schema.h"

#include <nlohmann/json.hpp>

#include "formats/gltf/json_rule.h"
#include "promin/validate.h"

namespace promin {
namespace {

using namespace rules;

/// The rule for a length: a size that fp32 arithmetic can square.
constexpr JsonRule length(std::string_view path) {
  return number(path, kMinSize, kMaxCoordinate);
}
constexpr JsonRule length_or_zero(std::string_view path) {
  return number(path, 0.0, kMaxCoordinate);
}
/// Powers and factors of light are not negative, but may exceed 1.
constexpr JsonRule factor(std::string_view path) {
  return number(path, 0.0, kMaxCoordinate);
}
constexpr JsonRule color(std::string_view path) {
  return numbers(path, 3, 0.0, kMaxCoordinate);
}

constexpr double kMaxBytes = 0x1p53;
constexpr double kMaxCount = 0x1p31 - 1.0;
constexpr double kMaxScalar = 1e30;
/// Exporters that think in fp32 write pi/2 a little too large.
constexpr double kHalfPi = 1.5707964;
constexpr double kPi = 3.141592653589793;
constexpr double kJustUnder = 1.0 - 0x1p-52;
constexpr double kTiny = 1e-9;

#define PROMIN_LIGHTS "extensions.KHR_lights_punctual.lights"
#define PROMIN_SHAPES "extensions.KHR_implicit_shapes.shapes"
#define PROMIN_SKIES "extensions.OMI_environment_sky.skies"
#define PROMIN_LINK "meshes[].primitives[].extensions.PROMIN_mesh_primitive_implicit_shape"
#define PROMIN_COAT "materials[].extensions.KHR_materials_clearcoat"
#define PROMIN_SHEEN "materials[].extensions.KHR_materials_sheen"
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
    needed(object("asset")),
    needed(text("asset.version")),
    text("asset.minVersion"),
    array("extensionsUsed"),
    text("extensionsUsed[]"),
    array("extensionsRequired"),
    text("extensionsRequired[]"),

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

    array("buffers"),
    object("buffers[]"),
    text("buffers[].uri"),
    needed(integer("buffers[].byteLength", 1, kMaxBytes)),
    object("buffers[].extensions"),
    object("buffers[].extensions.*"),

    array("bufferViews"),
    object("bufferViews[]"),
    needed(index("bufferViews[].buffer", "buffers")),
    integer("bufferViews[].byteOffset", 0, kMaxBytes),
    needed(integer("bufferViews[].byteLength", 1, kMaxBytes)),
    integer("bufferViews[].byteStride", 4, 252),
    object("bufferViews[].extensions"),
    object("bufferViews[].extensions.*"),
    PROMIN_MESHOPT("bufferViews[].extensions.EXT_meshopt_compression"),
    PROMIN_MESHOPT("bufferViews[].extensions.KHR_meshopt_compression"),

    array("accessors"),
    object("accessors[]"),
    index("accessors[].bufferView", "bufferViews"),
    integer("accessors[].byteOffset", 0, kMaxBytes),
    needed(choice("accessors[].componentType", "5120|5121|5122|5123|5125|5126")),
    boolean("accessors[].normalized"),
    needed(integer("accessors[].count", 1, kMaxCount)),
    needed(choice("accessors[].type", "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4")),
    object("accessors[].extensions"),
    object("accessors[].extensions.*"),
    object("accessors[].sparse"),
    needed(integer("accessors[].sparse.count", 1, kMaxCount)),
    needed(object("accessors[].sparse.indices")),
    needed(index("accessors[].sparse.indices.bufferView", "bufferViews")),
    integer("accessors[].sparse.indices.byteOffset", 0, kMaxCount),
    needed(choice("accessors[].sparse.indices.componentType", "5121|5123|5125")),
    needed(object("accessors[].sparse.values")),
    needed(index("accessors[].sparse.values.bufferView", "bufferViews")),
    integer("accessors[].sparse.values.byteOffset", 0, kMaxCount),

    array("materials"),
    object("materials[]"),
    text("materials[].name"),
    object("materials[].pbrMetallicRoughness"),
    numbers("materials[].pbrMetallicRoughness.baseColorFactor", 4, 0.0, kMaxCoordinate),
    number("materials[].pbrMetallicRoughness.metallicFactor", 0.0, 1.0),
    number("materials[].pbrMetallicRoughness.roughnessFactor", 0.0, 1.0),
    color("materials[].emissiveFactor"),
    PROMIN_TEXTURE_INFO("materials[].pbrMetallicRoughness.baseColorTexture"),
    PROMIN_TEXTURE_INFO("materials[].pbrMetallicRoughness.metallicRoughnessTexture"),
    PROMIN_TEXTURE_INFO("materials[].normalTexture"),
    number("materials[].normalTexture.scale", -kMaxScalar, kMaxScalar),
    PROMIN_TEXTURE_INFO("materials[].occlusionTexture"),
    number("materials[].occlusionTexture.strength", 0.0, 1.0),
    PROMIN_TEXTURE_INFO("materials[].emissiveTexture"),
    choice("materials[].alphaMode", "OPAQUE|MASK|BLEND"),
    number("materials[].alphaCutoff", 0.0, kMaxScalar),
    boolean("materials[].doubleSided"),
    object("materials[].extensions"),
    object("materials[].extensions.*"),
    factor("materials[].extensions.KHR_materials_emissive_strength.emissiveStrength"),
    number("materials[].extensions.KHR_materials_ior.ior", 0.0, kMaxScalar),
    number(PROMIN_TRANSMISSION ".transmissionFactor", 0.0, 1.0),
    PROMIN_TEXTURE_INFO(PROMIN_TRANSMISSION ".transmissionTexture"),
    factor(PROMIN_VOLUME ".thicknessFactor"),
    number(PROMIN_VOLUME ".attenuationDistance", 1e-30, kMaxScalar),
    color(PROMIN_VOLUME ".attenuationColor"),
    factor("materials[].extensions.KHR_materials_dispersion.dispersion"),
    number(PROMIN_SPECULAR ".specularFactor", 0.0, 1.0),
    color(PROMIN_SPECULAR ".specularColorFactor"),
    PROMIN_TEXTURE_INFO(PROMIN_SPECULAR ".specularTexture"),
    PROMIN_TEXTURE_INFO(PROMIN_SPECULAR ".specularColorTexture"),
    color(PROMIN_SHEEN ".sheenColorFactor"),
    number(PROMIN_SHEEN ".sheenRoughnessFactor", 0.0, 1.0),
    PROMIN_TEXTURE_INFO(PROMIN_SHEEN ".sheenColorTexture"),
    PROMIN_TEXTURE_INFO(PROMIN_SHEEN ".sheenRoughnessTexture"),
    number(PROMIN_COAT ".clearcoatFactor", 0.0, 1.0),
    number(PROMIN_COAT ".clearcoatRoughnessFactor", 0.0, 1.0),
    PROMIN_TEXTURE_INFO(PROMIN_COAT ".clearcoatTexture"),
    PROMIN_TEXTURE_INFO(PROMIN_COAT ".clearcoatRoughnessTexture"),
    PROMIN_TEXTURE_INFO(PROMIN_COAT ".clearcoatNormalTexture"),
    number(PROMIN_COAT ".clearcoatNormalTexture.scale", -kMaxScalar, kMaxScalar),
    numbers(PROMIN_GLOSSY ".diffuseFactor", 4, 0.0, kMaxCoordinate),
    color(PROMIN_GLOSSY ".specularFactor"),
    number(PROMIN_GLOSSY ".glossinessFactor", 0.0, 1.0),
    PROMIN_TEXTURE_INFO(PROMIN_GLOSSY ".diffuseTexture"),
    PROMIN_TEXTURE_INFO(PROMIN_GLOSSY ".specularGlossinessTexture"),
    color(PROMIN_PHONG ".ambientFactor"),
    color(PROMIN_PHONG ".diffuseFactor"),
    color(PROMIN_PHONG ".specularFactor"),
    color(PROMIN_PHONG ".reflectionFactor"),
    factor(PROMIN_PHONG ".shininess"),
    color(PROMIN_PHONG ".transmissionFactor"),
    number(PROMIN_PHONG ".ior", kTiny, kMaxCoordinate),
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
    needed(number("cameras[].perspective.yfov", kTiny, kPi* kJustUnder)),
    number("cameras[].perspective.aspectRatio", kTiny, 1e9),
    length_or_zero("cameras[].perspective.znear"),
    object("cameras[].orthographic"),
    needed(length("cameras[].orthographic.xmag")),
    needed(length("cameras[].orthographic.ymag")),
    length_or_zero("cameras[].orthographic.znear"),

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
    index(PROMIN_MAPPINGS "[].variants[]", PROMIN_VARIANTS),

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
    length(PROMIN_LIGHTS "[].range"),
    object(PROMIN_LIGHTS "[].spot"),
    number(PROMIN_LIGHTS "[].spot.innerConeAngle", 0.0, kHalfPi),
    number(PROMIN_LIGHTS "[].spot.outerConeAngle", 0.0, kHalfPi),
    object(PROMIN_LIGHTS "[].extensions"),
    object(PROMIN_LIGHTS "[].extensions.PROMIN_lights_phong"),
    choice(PROMIN_LIGHTS "[].extensions.PROMIN_lights_phong.attenuation", "none|inverse_square"),
    color(PROMIN_LIGHTS "[].extensions.PROMIN_lights_phong.diffuseColor"),
    color(PROMIN_LIGHTS "[].extensions.PROMIN_lights_phong.specularColor"),

    index("scenes[].extensions.OMI_environment_sky.sky", PROMIN_SKIES),
    needed(array(PROMIN_SKIES)),
    object(PROMIN_SKIES "[]"),
    needed(text(PROMIN_SKIES "[].type")),
    object(PROMIN_SKIES "[].plain"),
    color(PROMIN_SKIES "[].plain.color"),
    color(PROMIN_SKIES "[].ambientLightColor"),
    number(PROMIN_SKIES "[].ambientSkyContribution", 0.0, 1.0),
    object(PROMIN_SKIES "[].gradient"),
    needed(color(PROMIN_SKIES "[].gradient.topColor")),
    needed(color(PROMIN_SKIES "[].gradient.horizonColor")),
    needed(color(PROMIN_SKIES "[].gradient.bottomColor")),
    number(PROMIN_SKIES "[].gradient.topCurve", kTiny, kMaxScalar),
    number(PROMIN_SKIES "[].gradient.bottomCurve", kTiny, kMaxScalar),
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

#undef PROMIN_LIGHTS
#undef PROMIN_SHAPES
#undef PROMIN_SKIES
#undef PROMIN_LINK
#undef PROMIN_PHONG
#undef PROMIN_GLOSSY
#undef PROMIN_VARIANTS
#undef PROMIN_MAPPINGS
#undef PROMIN_INSTANCES
#undef PROMIN_TEXTURE_INFO
#undef PROMIN_MESHOPT
#undef PROMIN_DRACO

}  // namespace

void check_gltf_schema(nlohmann::json& document, LoadReport& report) {
  if (!document.is_object()) {
    report.refuse("the file is no JSON object", "the top level", "export the file again");
    return;
  }
  for (const JsonRule& rule : kRules) check_json_rule(document, rule, report);
}

}  // namespace promin
