// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The definitions that host and shaders share, written once for both compilers. All members are vec4 or uvec4, so that
// C++, std140 and std430 agree; tests/gpu/layout_test.cpp compares the offsets with those of the SPIR-V.
#ifndef PROMIN_LAYOUT_H
#define PROMIN_LAYOUT_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace promin::layout {
using glm::uvec4;
using glm::vec4;
using uint = uint32_t;
#define LAYOUT_CONSTANT inline constexpr uint
#define LAYOUT_FLOAT inline constexpr float
#else
#define LAYOUT_CONSTANT const uint
#define LAYOUT_FLOAT const float
#endif

// Features that a scene may use, and that a caller may request from a pipeline for any scene. Each is the number of a
// bit in two words, for which a pipeline is specialised. The tables of promin/kinds define kinds, lights, features and
// debug views.
#ifdef __cplusplus
enum class Feature : uint {};
#define LAYOUT_FEATURE(NAME, BIT) inline constexpr Feature NAME{BIT};
#else
#define LAYOUT_FEATURE(NAME, BIT) const uint NAME = BIT;
#endif
LAYOUT_CONSTANT FEATURE_WORDS = 2u;

#define PROMIN_PRIMITIVE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  LAYOUT_CONSTANT KIND_##KIND = NUMBER;                                  \
  LAYOUT_FEATURE(FEATURE_##FEATURE, BIT)
#include "promin/kinds/primitives.def"
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  LAYOUT_CONSTANT LIGHT_##KIND = NUMBER;                                   \
  LAYOUT_FEATURE(FEATURE_##FEATURE, BIT)
#include "promin/kinds/lights.def"
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  LAYOUT_CONSTANT MATERIAL_##KIND = NUMBER;                             \
  LAYOUT_FEATURE(FEATURE_##FEATURE, BIT)
#include "promin/kinds/materials.def"
#define PROMIN_FEATURE(FEATURE, BIT, NAME) LAYOUT_FEATURE(FEATURE_##FEATURE, BIT)
#define PROMIN_REQUEST(FEATURE, BIT, NAME) LAYOUT_FEATURE(FEATURE_##FEATURE, BIT)
#include "shared/features.def"

// The kind of a picture: light, or a debug view. The number of the view is stored in the second word of features.
LAYOUT_CONSTANT DEBUG_VIEW_NONE = 0u;
#define PROMIN_DEBUG_VIEW(KIND, ENUMERATOR, PREFIX, NUMBER, NAME, REQUEST, HELP) \
  LAYOUT_CONSTANT DEBUG_VIEW_##KIND = NUMBER;
#include "promin/kinds/debug_views.def"
LAYOUT_CONSTANT DEBUG_VIEW_SHIFT = 24u;
LAYOUT_CONSTANT DEBUG_VIEW_MASK = 0xFFu;
// The number of steps at which the heat map of DEBUG_VIEW_STEPS is white.
LAYOUT_CONSTANT HEAT_STEPS = 64u;

// Descriptor bindings; Vulkan's required minimum is four storage buffers a stage.
LAYOUT_CONSTANT BINDING_VIEW = 0u;
LAYOUT_CONSTANT BINDING_NODES = 1u;
LAYOUT_CONSTANT BINDING_PRIMITIVES = 2u;
LAYOUT_CONSTANT BINDING_SHADING = 3u;
LAYOUT_CONSTANT BINDING_FILM = 4u;
LAYOUT_CONSTANT BINDING_RAYS = 5u;
LAYOUT_CONSTANT BINDING_HITS = 6u;
LAYOUT_CONSTANT BINDING_NODE_TEXELS = 7u;
LAYOUT_CONSTANT BINDING_PRIMITIVE_TEXELS = 8u;
LAYOUT_CONSTANT BINDING_RAY_TEXELS = 9u;
LAYOUT_CONSTANT BINDING_SHADING_TEXELS = 10u;
LAYOUT_CONSTANT BINDING_FILM_TEXELS = 11u;
LAYOUT_CONSTANT BINDING_TEXTURE_TEXELS = 12u;

// Specialisation constants.
LAYOUT_CONSTANT CONSTANT_FEATURES = 0u;  // the first word
LAYOUT_CONSTANT CONSTANT_STACK_SIZE = 1u;
LAYOUT_CONSTANT CONSTANT_ALL_ASK_FOR_ANY = 2u;
LAYOUT_CONSTANT CONSTANT_FETCHES_TEXELS = 3u;
LAYOUT_CONSTANT CONSTANT_PACKET_SIZE = 4u;
LAYOUT_CONSTANT CONSTANT_MORE_FEATURES = 5u;  // the second word
LAYOUT_CONSTANT CONSTANT_STEPS_TOGETHER = 6u;
LAYOUT_CONSTANT CONSTANT_WAITS_WITH_SOLIDS = 7u;
LAYOUT_CONSTANT CONSTANT_FETCHES_FILM_TEXELS = 8u;
LAYOUT_CONSTANT CONSTANT_LISTS_CROSSINGS = 9u;

// A workgroup traces a block of BLOCK_SIZE x BLOCK_SIZE pixels, one per lane (Vulkan guarantees 128 invocations).
LAYOUT_CONSTANT BLOCK_SIZE = 8u;

// A node has up to four children with their boxes in bytes. A plane of a box lies at origin + byte * 2^(exponent -
// 127), and each axis has an exponent of its own. The four bytes of a word belong to the four children, the lowest byte
// to the first. An inner child is stored as its index. A leaf has CHILD_IS_LEAF, its count - 1 in the four bits below,
// and its first primitive in the rest.
struct Node {
  uvec4 frame;     // bits of the origin; w = exponents of x, y, z, the lowest byte first, then how many children
  uvec4 lo;        // lower planes of x, y, z; w = upper planes of x
  uvec4 hi;        // upper planes of y, z; 0, 0
  uvec4 children;  // 0 beyond the last
};
LAYOUT_CONSTANT NODE_WIDTH = 4u;
LAYOUT_CONSTANT NODE_TEXELS = 4u;
LAYOUT_CONSTANT CHILD_IS_LEAF = 0x80000000u;
LAYOUT_CONSTANT CHILD_COUNT_SHIFT = 27u;
LAYOUT_CONSTANT CHILD_COUNT_MASK = 15u;
LAYOUT_CONSTANT CHILD_FIRST_MASK = 0x07FFFFFFu;
// Traversal keeps a node's index in 24 bits (family.glsl).
LAYOUT_CONSTANT MAX_NODES = 0x00FFFFFFu;

// A primitive. Those of the tree come first, in leaf order, then the unbounded ones. The kind determines a, b and c.x:
// they are defined by the comment at its pack() and by its shader file in primitives/. c.y is the primitive's number in
// (object, primitive) order, which breaks ties. c.z is the kind. c.w has hashes of the object, in the lower 16 bits,
// and of the primitive; debug views turn them into colours.
struct Primitive {
  vec4 a;
  vec4 b;
  uvec4 c;
};
LAYOUT_CONSTANT PRIMITIVE_TEXELS = 3u;
LAYOUT_CONSTANT SHAPE_IS_OPEN = 0x80000000u;  // in c.x of cylinders and cones

// The data for shading the primitive at the same index: xyz = the corners' vertex indices (triangles with normals,
// colours, texture coordinates or tangents), w = material index and SURFACE_* bits.
struct SurfaceRecord {
  uvec4 corners_material;
};
LAYOUT_CONSTANT SURFACE_IS_SMOOTH = 0x80000000u;
LAYOUT_CONSTANT SURFACE_IS_COLORED = 0x40000000u;
LAYOUT_CONSTANT SURFACE_HAS_UVS = 0x20000000u;
LAYOUT_CONSTANT SURFACE_HAS_TANGENTS = 0x10000000u;
LAYOUT_CONSTANT SURFACE_MATERIAL_MASK = 0x0FFFFFFFu;

// The model determines a, b, c and d: the shader files in materials/ define them.
struct MaterialRecord {
  vec4 a;
  vec4 b;
  vec4 c;
  vec4 d;
  vec4 cover;     // x = alpha; y = the least alpha that is there; numbers of texture slots: z = of colour and alpha,
                  // w = of emissive
  vec4 emissive;  // w = bits: MATERIAL_* and flags
};
LAYOUT_CONSTANT MATERIAL_TEXELS = 6u;
LAYOUT_CONSTANT MATERIAL_MODEL_MASK = 0xFFu;
LAYOUT_CONSTANT MATERIAL_HAS_HOLES = 0x100u;  // where the texture's alpha says so
LAYOUT_CONSTANT MATERIAL_IS_ONE_SIDED = 0x200u;
LAYOUT_CONSTANT MATERIAL_BLENDS = 0x400u;    // with what is behind, by alpha
LAYOUT_CONSTANT MATERIAL_GLASS_SHIFT = 16u;  // the number of its GlassRecord, from 1 on, 0: it has none
LAYOUT_CONSTANT MOST_GLASSES = 0x3FFFu;
// The largest number of surfaces that blend on a ray; the next one counts as opaque.
LAYOUT_CONSTANT MOST_LAYERS = 64u;
// A surface that lets through less than this counts as opaque.
LAYOUT_FLOAT LEAST_SHARE_BEHIND = 0.0009765625f;
// From this roughness on a metallic-roughness material shows only the environment and traces no mirror ray.
LAYOUT_FLOAT ROUGHEST_MIRROR = 0.4f;

// Rare properties of metallic-roughness materials, from extensions of glTF. The material's record has the number of
// this record, from 1 on, in d.x. Slots are numbers of texture slots.
struct ExtensionRecord {
  vec4 coat;         // x = how much of it there is; y = roughness; z = scale of its normals
  uvec4 coat_slots;  // x = of how much there is, y = of roughness, z = of normals
  vec4 sheen;        // xyz = colour; w = roughness
  vec4 reflectance;  // xyz = the dielectric's at normal incidence, before what follows; w = factor of all it reflects
  uvec4 slots;       // x = of the sheen's colour, y = of its roughness; of reflectance: z = of w, w = of xyz
  vec4 scattering;   // to the other side: xyz = colour; w = share
  vec4 thin_film;    // x = share; y = index of refraction; z = thickness in nanometres; w = thickness minus that
                     // where its texture is 0
  vec4 anisotropy;   // of anisotropic highlights: x = strength; y, z = cosine and sine of their rotation
  uvec4 rare_slots;  // x = of the share of scattering, y = of its colour, z = of the film's share, w = of its thickness
  uvec4 anisotropy_slot;  // x
};
LAYOUT_CONSTANT EXTENSION_TEXELS = 10u;

// The data of materials that transmit light, or whose reflection depends on the angle (glass.glsl).
struct GlassRecord {
  vec4 transmission;  // xyz = share of light that goes through; w = index of refraction
  vec4 absorption;    // xyz: 2^(-absorption x) is the share of light that is left after a length x
  vec4 reflectance;   // xyz = of metallic-roughness materials: factor of the reflectance at normal incidence; w = index
                      // of refraction of blue less that of green, and of green less that of red
  uvec4 bits;         // x = GLASS_*; y = number of the texture slot of what goes through
};
LAYOUT_CONSTANT GLASS_TEXELS = 4u;
LAYOUT_CONSTANT GLASS_IS_CLEAR = 1u;    // transmits light
LAYOUT_CONSTANT GLASS_IS_THIN = 2u;     // a wall without an inside, which does not bend light
LAYOUT_CONSTANT GLASS_IS_FRESNEL = 4u;  // Phong: reflection depends on the angle
// The largest number of secondary rays of a sample in a scene with glass, and the smallest weight of a ray. The
// environment replaces other rays (Dispatch::outcome).
LAYOUT_CONSTANT MOST_TREE_RAYS = 64u;
LAYOUT_FLOAT LEAST_TREE_WEIGHT = 0.001953125f;
LAYOUT_CONSTANT COLORS = 3u;  // that dispersion separates

// A material's reference to a texture (textures.glsl). u = to_u . (s, t, 1), and the same for v.
struct TextureSlotRecord {
  vec4 to_u;  // w = bits of TEXTURE_*
  vec4 to_v;
  uvec4 image;  // x = its first word, y = width, z = height, w = levels
};
LAYOUT_CONSTANT TEXTURE_SLOT_TEXELS = 3u;
LAYOUT_CONSTANT TEXTURE_UV_SET = 1u;  // the number of the set
LAYOUT_CONSTANT TEXTURE_IS_SRGB = 2u;
LAYOUT_CONSTANT TEXTURE_MAGNIFIED_LINEARLY = 4u;
LAYOUT_CONSTANT TEXTURE_MINIFIED_LINEARLY = 8u;
LAYOUT_CONSTANT TEXTURE_HAS_LEVELS = 16u;
LAYOUT_CONSTANT TEXTURE_LEVELS_LINEAR = 32u;
LAYOUT_CONSTANT TEXTURE_WRAP_U_SHIFT = 8u;
LAYOUT_CONSTANT TEXTURE_WRAP_V_SHIFT = 10u;
LAYOUT_CONSTANT TEXTURE_WRAP_MASK = 3u;
LAYOUT_CONSTANT WRAP_REPEAT = 0u;
LAYOUT_CONSTANT WRAP_MIRRORED = 1u;
LAYOUT_CONSTANT WRAP_CLAMP = 2u;

// The number of entries along each side of the table of lobes (shading_records.glsl) and of the table of sheens, whose
// entries are fractions of this largest one.
LAYOUT_CONSTANT LOBE_TABLE_SIDE = 32u;
LAYOUT_FLOAT LARGEST_SHEEN_SHARE = 2.0f;

// Texels along each side of the coarsest levels of a sky (sky_levels.def, environment.glsl).
LAYOUT_CONSTANT LEAST_SKY_SIDE = 32u;

struct LightRecord {
  vec4 position;   // w = 1 / range
  vec4 direction;  // the direction in which the light travels; w = cosine of a spot's outer angle
  vec4 diffuse;    // w = 1 / max(0.001, cos inner - cos outer)
  vec4 specular;
  uvec4 kind;  // x = LIGHT_*, y = 1 if it falls off with distance
};
LAYOUT_CONSTANT LIGHT_TEXELS = 5u;

// The constants of a view of a scene (uniform buffer). No branch or loop depends on them; constants that control flow
// depends on are in Dispatch.
struct ViewConstants {
  vec4 eye;    // w = near: distance of the viewport plane
  vec4 look;   // w = width of a sample's cone of sight at the eye, with TEXTURES
  vec4 right;  // step from one pixel to the next at distance 1 (orthographic: in the world); w = growth of that cone
  vec4 up;
  vec4 ambient;
  vec4 background;       // w = SHOWS_*: what rays from the camera see
  vec4 backdrop_top;     // w = factor by which mirrors and glass see it
  vec4 backdrop_bottom;  // w = rows of the picture
  vec4 backdrop_rise;   // upwards, 1 over the picture's height at distance 1 (orthographic: in the world); w = 1 for an
                        // orthographic camera
  vec4 tree_bounds;     // center and max-norm radius of the tree's primitives
  vec4 film_center;     // x, y = half the picture's size in pixels
  uvec4 first_index;    // x = materials, y = lights, z = normals, w = colours: first index in their views of shading
  uvec4 first_lookup;   // x = table of lobes, y = sky, as texels of shading; z = side of the sky's sharpest level;
                        // w = extensions, as ExtensionRecords
  uvec4 first_texture;  // x = texture coordinates, y = tangents, z = slots, as texels of shading; w = words of images
  uvec4 first_glass;    // x = GlassRecords; y, z = the media in which the camera is (glass.glsl)
  vec4 irradiance[9];   // of a sky: coefficients of its light over pi (environment.glsl)
};

LAYOUT_FLOAT SHOWS_BACKGROUND = 0.0f;
LAYOUT_FLOAT SHOWS_SKY = 1.0f;
LAYOUT_FLOAT SHOWS_BACKDROP = 2.0f;

// The constants that branches and loops depend on, at the head of the output buffer. They are not in push constants or
// a uniform buffer, because lavapipe would compile the shader again for each of their values.
struct Dispatch {
  uvec4 range;     // x = first block, y = one past the last, z = sample, w = mirror bounces
                   // casting: x = first ray, y = one past the last
  uvec4 window;    // x, y = first pixel; z, w = width and height in pixels
  uvec4 sampling;  // x = samples a pixel, y = bits of x of the sample's place, z = blocks a row,
                   // w = 1 for an orthographic camera
  uvec4 counts;    // x = index of the first plane's primitive, y = planes, z = lights, w = LOOP_CHECK_TURNS
  uvec4 outcome;   // casting: x = 1 after the dispatch if were_loops_cut(); 0 else
                   // pictures: y = the most rays of a sample's tree, z = bits of the least weight of one,
                   // w = bits of y of the sample's place in its pixel
};

// The state of the stream of paths, which lies behind the pixels of a film (stream.glsl), for a piece of a picture.
struct StreamState {
  uvec4 place;        // x = the first record, y = most paths, z = sources of a turn, w = most rows of workgroups
  uvec4 turn;         // x = its number, before the first -1; y, z = paths listed in even and odd turns; w = how many
                      // of this turn's have a ray
  uvec4 shadow_rays;  // x = how many are listed; y = records of a path, its sources among them
  uvec4 list_groups;  // workgroups of each dispatch of the turn, as Vulkan takes them
  uvec4 shadow_groups;
  uvec4 path_groups;
};
// Number of uvec4 records of a path, and further ones for each light source of a turn.
LAYOUT_CONSTANT STREAM_PATH_RECORDS = 7u;
LAYOUT_CONSTANT STREAM_SOURCE_RECORDS = 1u;
// Further records of a path with FEATURE_DIFFUSE_TRANSMISSION.
LAYOUT_CONSTANT STREAM_BEHIND_RECORDS = 1u;
// Further records of a path with FEATURE_GLASS, and for each ray that waits until the path has ended.
LAYOUT_CONSTANT STREAM_GLASS_RECORDS = 2u;
LAYOUT_CONSTANT STREAM_WAITING_RECORDS = 4u;
LAYOUT_CONSTANT STREAM_SOURCES = 16u;  // most sources of a turn
LAYOUT_CONSTANT STREAM_LISTS = 2u;
LAYOUT_CONSTANT STREAM_BIN_BITS = 9u;  // of the bins by which rays are sorted (ray_bins.glsl)
LAYOUT_CONSTANT STREAM_BINS = 1u << STREAM_BIN_BITS;
LAYOUT_CONSTANT STREAM_LANES = 64u;
// The head of a film, before its pixels. Each shader block for the film begins with it, under its own names, and
// FilmHead on the host is the same. Each lane of a workgroup has its own counters (film.glsl).
#define FILM_HEAD(DISPATCH, STREAM, RAY_COUNTS, PASS_COUNTS) \
  Dispatch DISPATCH;                                         \
  StreamState STREAM;                                        \
  uvec4 RAY_COUNTS[BLOCK_SIZE * BLOCK_SIZE];                 \
  uvec4 PASS_COUNTS[BLOCK_SIZE * BLOCK_SIZE];
// Offset of a film's pixels in texels.
LAYOUT_CONSTANT FILM_HEAD_TEXELS = 5u + 6u + 64u + 64u;

// A number above one that the compiler does not know (loop_check.glsl).
LAYOUT_CONSTANT LOOP_CHECK_TURNS = 2u;

// A ray to cast. The direction has any length, and a hit has tmin < t < tmax in its units.
struct RayRecord {
  vec4 origin_tmin;
  vec4 direction_tmax;
};
LAYOUT_CONSTANT RAY_TEXELS = 2u;

// The result of a ray. FEATURE_STEP_COUNTS adds the counts, each clamped to its 16 bits. For an any-hit ray only a.x
// (0, or infinite on a miss), a.y and the counts are written.
struct HitRecord {
  uvec4 a;  // bits of t (infinite on a miss), the primitive's number in order (NO_ORDER on a miss), bits of u and v
  uvec4 b;  // bits of the geometric normal; w = node steps + primitive tests * 2^16
};
LAYOUT_CONSTANT NO_ORDER = 0xFFFFFFFFu;
// Crossings (crossings.comp): a record for each ray, then those of all crossings. In a ray's record a.x is the number
// of its crossings; with LISTS_CROSSINGS a.y is the record of the first and a.z the space, both set before the
// dispatch. A crossing's record is like that of a hit, but b.w is 1 if the ray leaves a solid, else 0.

// With FEATURE_LISTED_SAMPLES each pixel of the film is a sample of a pixel of the picture. Before it is traced, x and
// y are the bits of its position in that pixel, and z is that pixel, with its row above 16 bits, or this value.
// Afterwards xyz is its radiance.
LAYOUT_CONSTANT NO_LISTED_SAMPLE = 0xFFFFFFFFu;

// The records of a film, each kind for all pixels together. The first has the sum over a pixel's samples, and `order`
// of the primitive that it shows. With FEATURE_AOVS, records of the middle sample's hit follow.
LAYOUT_CONSTANT AOV_NORMAL = 1u;  // geometric; w = distance from the eye
LAYOUT_CONSTANT AOV_ALBEDO = 2u;  // w = material
LAYOUT_CONSTANT AOV_POSITION = 3u;
LAYOUT_CONSTANT AOV_SHADING_NORMAL = 4u;
LAYOUT_CONSTANT AOV_MEASURES = 5u;  // x, y = texture coordinates; z = distance along the view; w = steps, an integer
LAYOUT_CONSTANT AOV_RECORDS = 6u;
// With FEATURE_LIGHT_AOVS the parts of the sum follow after these.
LAYOUT_CONSTANT PART_EMISSION = 0u;      // what the surface that the camera sees emits,
LAYOUT_CONSTANT PART_DIRECT = 1u;        // what lights bring to it,
LAYOUT_CONSTANT PART_INDIRECT = 2u;      // what its surroundings do,
LAYOUT_CONSTANT PART_REFLECTION = 3u;    // mirror rays from it,
LAYOUT_CONSTANT PART_TRANSMISSION = 4u;  // and rays through it
LAYOUT_CONSTANT PART_BACKGROUND = 5u;    // what is seen beside and behind surfaces; w = how much of the pixel shows it
LAYOUT_CONSTANT LIGHT_PARTS = 6u;
LAYOUT_CONSTANT PART_SEEN =
    6u;  // no part: xyz = light of the point at hand without lights, w = parts (light_parts.glsl)
LAYOUT_CONSTANT PART_RECORDS = 7u;
// With FEATURE_SAMPLE_IDS the `order` of each of this number of samples follows, four per record.
LAYOUT_CONSTANT SAMPLE_IDS = 16u;
// With FEATURE_SAMPLE_RANGES, on films that are not of a list, the smallest and the largest value of its samples
// follow, each by channel.
LAYOUT_CONSTANT RANGE_LEAST = 0u;
LAYOUT_CONSTANT RANGE_LARGEST = 1u;
LAYOUT_CONSTANT RANGE_RECORDS = 2u;
// With FEATURE_UNLIT_SHARE one more record follows: the unlit surfaces and the backdrop that the camera sees, summed
// over samples; w = in how many samples it sees them.

// The log of FEATURE_RAY_LOG: an entry for each ray of the path, and one (LOG_SOURCE) for each light source that may
// light its hit. Sources come before the ray whose hit they light. Rays are stored as traced: the direction's largest
// component is in [1, 2), and t is in its units.
struct RayLog {
  uvec4 ids;  // x = LOG_PATH or LOG_SOURCE; y = the bounce or the source; z = the material; w = where a ray comes from,
              // or 1 where a source has a shadow ray
  vec4 origin_tmin;
  vec4 direction_tmax;
  uvec4 hit;            // as HitRecord::a; for a shadow ray, what it met first
  vec4 position;        // w = lift
  vec4 normal;          // geometric, as Hit::normal
  vec4 shading_normal;  // faces the ray
  vec4 weight;          // of what comes along the ray; w = how much of what is behind it the hit covers
  vec4 own;             // ambient and emitted light
  vec4 radiance;        // the path's so far; a source's contribution
};
LAYOUT_CONSTANT LOG_PATH = 0u;
LAYOUT_CONSTANT LOG_SOURCE = 1u;
// The origin of a path's ray.
LAYOUT_CONSTANT LOG_CAMERA = 0u;
LAYOUT_CONSTANT LOG_REFLECTION = 1u;
LAYOUT_CONSTANT LOG_REFRACTION = 2u;
LAYOUT_CONSTANT LOG_THROUGH = 3u;  // the same ray, behind a surface that blends

#ifdef __cplusplus
static_assert(sizeof(RayLog) == 160);
static_assert(sizeof(RayRecord) == 32 && sizeof(HitRecord) == 32);
static_assert(sizeof(Node) == 64 && sizeof(Primitive) == 48 && sizeof(SurfaceRecord) == 16);
static_assert(sizeof(MaterialRecord) == 96 && sizeof(LightRecord) == 80 && sizeof(ViewConstants) == 384);
static_assert(sizeof(Dispatch) == 80 && sizeof(StreamState) == 96);
struct FilmHead {
  FILM_HEAD(dispatch, stream, ray_counts, pass_counts)
};
static_assert(sizeof(FilmHead) == 16 * FILM_HEAD_TEXELS);
#undef FILM_HEAD
static_assert(sizeof(Node) == 16 * NODE_TEXELS && sizeof(Primitive) == 16 * PRIMITIVE_TEXELS);
static_assert(sizeof(MaterialRecord) == 16 * MATERIAL_TEXELS && sizeof(LightRecord) == 16 * LIGHT_TEXELS);
static_assert(sizeof(ExtensionRecord) == 16 * EXTENSION_TEXELS && sizeof(GlassRecord) == 16 * GLASS_TEXELS);
static_assert(sizeof(RayRecord) == 16 * RAY_TEXELS && sizeof(TextureSlotRecord) == 16 * TEXTURE_SLOT_TEXELS);
#undef LAYOUT_CONSTANT
#undef LAYOUT_FLOAT
#undef LAYOUT_FEATURE
}  // namespace promin::layout
#endif
#endif
