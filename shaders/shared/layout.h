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

// Features that a scene may use, and that a caller may request from a pipeline for any scene. Each feature is the
// number of a bit in two words. A pipeline is specialised for these words. The tables of promin/kinds define kinds,
// lights, features and debug views.
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
LAYOUT_CONSTANT DEBUG_VIEW_MASK = 0x7Fu;
// The number of steps at which the heat map of DEBUG_VIEW_STEPS is white.
LAYOUT_CONSTANT HEAT_STEPS = 64u;

// Descriptor bindings. Vulkan guarantees only four storage buffers per stage.
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
LAYOUT_CONSTANT CONSTANT_FEATURES = 0u;  // the first word of features
LAYOUT_CONSTANT CONSTANT_STACK_SIZE = 1u;
LAYOUT_CONSTANT CONSTANT_ALL_ASK_FOR_ANY = 2u;
LAYOUT_CONSTANT CONSTANT_FETCHES_TEXELS = 3u;
LAYOUT_CONSTANT CONSTANT_PACKET_SIZE = 4u;
LAYOUT_CONSTANT CONSTANT_MORE_FEATURES = 5u;  // the second word of features
LAYOUT_CONSTANT CONSTANT_STEPS_TOGETHER = 6u;
LAYOUT_CONSTANT CONSTANT_WAITS_WITH_SOLIDS = 7u;
LAYOUT_CONSTANT CONSTANT_FETCHES_FILM_TEXELS = 8u;
LAYOUT_CONSTANT CONSTANT_LISTS_CROSSINGS = 9u;
LAYOUT_CONSTANT CONSTANT_WAITS_WITH_HOLES = 10u;

// Side of a block in pixels. A workgroup traces a block, with one lane per pixel (Vulkan guarantees 128 invocations).
LAYOUT_CONSTANT BLOCK_SIZE = 8u;

// A node has up to four children with their boxes in bytes. A plane of a box lies at origin + byte * 2^(exponent -
// 127); each axis has its own exponent. The four bytes of a word belong to the four children, the lowest byte to the
// first child. An inner child is stored as the index of its node. A leaf is stored as CHILD_IS_LEAF, its number of
// primitives minus 1 in the four bits below, and its first primitive in the rest.
struct Node {
  uvec4 frame;     // bits of the origin; w = exponents of x, y, z, the lowest byte first, then the number of children
  uvec4 lo;        // lower planes of x, y, z; w = upper planes of x
  uvec4 hi;        // upper planes of y, z; 0, 0
  uvec4 children;  // words of the children, 0 beyond the last child
};
LAYOUT_CONSTANT NODE_WIDTH = 4u;
LAYOUT_CONSTANT NODE_TEXELS = 4u;
LAYOUT_CONSTANT CHILD_IS_LEAF = 0x80000000u;
LAYOUT_CONSTANT CHILD_COUNT_SHIFT = 27u;
LAYOUT_CONSTANT CHILD_COUNT_MASK = 15u;
LAYOUT_CONSTANT CHILD_FIRST_MASK = 0x07FFFFFFu;
// Largest number of nodes, because traversal stores a node's index in 24 bits (family.glsl).
LAYOUT_CONSTANT MAX_NODES = 0x00FFFFFFu;
// With FEATURE_INSTANCES, a leaf of the upper level with one reference and this bit is an instance. The bits below are
// the index of its two records, which follow the nodes and have their size. The first record: frame.xyz, lo.xyz, hi.xyz
// = rows of R; their w = c; children = the mesh's max-norm radius around its origin, the index of the mesh's root,
// the number of the instance's first primitive, the instance's max-norm radius in the world. The second record:
// frame.xyz, lo.xyz, hi.xyz = rows of E; frame.w = the material of all triangles or NO_INSTANCE_MATERIAL; lo.w = bits:
// INSTANCE_*.
LAYOUT_CONSTANT CHILD_IS_INSTANCE = 0x84000000u;
LAYOUT_CONSTANT CHILD_INSTANCE_MASK = 0xFC000000u;
LAYOUT_CONSTANT CHILD_INSTANCE_INDEX = 0x03FFFFFFu;
LAYOUT_CONSTANT INSTANCE_RECORDS = 2u;
LAYOUT_CONSTANT INSTANCE_HASH_MASK = 0xFFFFu;        // hash of the object, as in Primitive::c.w
LAYOUT_CONSTANT INSTANCE_IS_MIRRORED = 0x80000000u;  // R changes the handedness
LAYOUT_CONSTANT NO_INSTANCE_MATERIAL = 0xFFFFFFFFu;
// Hit::part in an instance is the index of its record plus this number, which is above the parts of all shapes.
LAYOUT_CONSTANT FIRST_INSTANCE_PART = 8u;

// A primitive. The primitives of the tree come first, in leaf order, then the unbounded primitives. The kind determines
// the meaning of a, b and c.x: the comment at the kind's pack() and its shader file in primitives/ define it. c.y is
// the primitive's number in (object, primitive) order, which breaks ties. c.z is the kind. c.w has hashes of the
// object, in the lower 16 bits, and of the primitive; debug views turn them into colours.
struct Primitive {
  vec4 a;
  vec4 b;
  uvec4 c;
};
LAYOUT_CONSTANT PRIMITIVE_TEXELS = 3u;
LAYOUT_CONSTANT SHAPE_IS_OPEN = 0x80000000u;  // a bit of c.x of cylinders and cones

// The data for shading the primitive with the same index: xyz = vertex indices of the corners (for triangles with
// normals, colours, texture coordinates or tangents), w = material index and SURFACE_* bits.
struct SurfaceRecord {
  uvec4 corners_material;
};
LAYOUT_CONSTANT SURFACE_IS_SMOOTH = 0x80000000u;
LAYOUT_CONSTANT SURFACE_IS_COLORED = 0x40000000u;
LAYOUT_CONSTANT SURFACE_HAS_UVS = 0x20000000u;
LAYOUT_CONSTANT SURFACE_HAS_TANGENTS = 0x10000000u;
LAYOUT_CONSTANT SURFACE_MATERIAL_MASK = 0x0FFFFFFFu;

// The model determines the meaning of a, b, c and d. The shader files in materials/ define it.
struct MaterialRecord {
  vec4 a;
  vec4 b;
  vec4 c;
  vec4 d;
  vec4 cover;     // x = alpha; y = the smallest alpha at which the surface is present; numbers of texture slots: z =
                  // colour and alpha,
                  // w = emission
  vec4 emissive;  // w = bits: MATERIAL_* and flags
};
LAYOUT_CONSTANT MATERIAL_TEXELS = 6u;
LAYOUT_CONSTANT MATERIAL_MODEL_MASK = 0xFFu;
LAYOUT_CONSTANT MATERIAL_HAS_HOLES = 0x100u;  // the surface is absent where the texture's alpha is small
LAYOUT_CONSTANT MATERIAL_IS_ONE_SIDED = 0x200u;
LAYOUT_CONSTANT MATERIAL_BLENDS = 0x400u;           // the surface blends with the surfaces behind it, by alpha
LAYOUT_CONSTANT MATERIAL_CATCHES_SHADOWS = 0x800u;  // an unlit material that shows only shadows
LAYOUT_CONSTANT MATERIAL_GLASS_SHIFT = 16u;  // from this bit on: number of the GlassRecord, counted from 1; 0 without
                                             // one
LAYOUT_CONSTANT MOST_GLASSES = 0x3FFFu;
// The largest number of surfaces that blend along a ray. The next surface counts as opaque.
LAYOUT_CONSTANT MOST_LAYERS = 64u;
// The smallest fraction of light that a surface transmits. A surface that transmits less counts as opaque.
LAYOUT_FLOAT LEAST_SHARE_BEHIND = 0.0009765625f;
// The roughness from which a metallic-roughness material reflects only the environment and traces no mirror ray.
LAYOUT_FLOAT ROUGHEST_MIRROR = 0.4f;

// Rare properties of metallic-roughness materials, from extensions of glTF. d.x of the material's record is the number
// of this record, counted from 1. Slots are numbers of texture slots.
struct ExtensionRecord {
  vec4 coat;         // x = weight of the coat; y = its roughness; z = scale of its normals
  uvec4 coat_slots;  // slots of the coat: x = weight, y = roughness, z = normals
  vec4 sheen;        // xyz = colour of the sheen; w = its roughness
  vec4 reflectance;  // xyz = reflectance of the dielectric at normal incidence, without the strength w; w = strength of
                     // its reflection
  uvec4 slots;       // slots: x = sheen's colour, y = sheen's roughness, z = strength, w = reflectance
  vec4 scattering;   // light scattered to the other side: xyz = colour; w = fraction
  vec4 thin_film;    // x = weight of the film; y = index of refraction; z = thickness in nanometres; w = thickness
                     // minus the thickness where its texture is 0
  vec4 anisotropy;   // anisotropic highlights: x = strength; y, z = cosine and sine of their rotation
  uvec4 rare_slots;  // slots: x = fraction of scattering, y = its colour, z = film's weight, w = film's thickness
  uvec4 anisotropy_slot;  // x = slot of anisotropy
};
LAYOUT_CONSTANT EXTENSION_TEXELS = 10u;

// Data of materials that transmit light, or whose reflection depends on the angle (glass.glsl).
struct GlassRecord {
  vec4 transmission;  // xyz = fraction of light that is transmitted; w = index of refraction
  vec4 absorption;    // xyz: 2^(-absorption x) is the fraction of light that remains after the length x
  vec4 reflectance;   // for metallic-roughness materials, xyz = factor of the reflectance at normal incidence; w =
                      // index of refraction of blue minus that of green, and of green minus that of red
  uvec4 bits;         // x = GLASS_*; y = number of the texture slot of the transmission
};
LAYOUT_CONSTANT GLASS_TEXELS = 4u;
LAYOUT_CONSTANT GLASS_IS_CLEAR = 1u;    // the material transmits light
LAYOUT_CONSTANT GLASS_IS_THIN = 2u;     // a wall without an inside, which does not bend light
LAYOUT_CONSTANT GLASS_IS_FRESNEL = 4u;  // for Phong: the reflection depends on the angle
// Limits of a sample in a scene with glass: the largest number of secondary rays, and the smallest weight of a ray. The
// environment replaces further rays (Dispatch::outcome).
LAYOUT_CONSTANT MOST_TREE_RAYS = 64u;
LAYOUT_FLOAT LEAST_TREE_WEIGHT = 0.001953125f;
LAYOUT_CONSTANT COLORS = 3u;  // number of colours that dispersion separates

// A material's reference to a texture (textures.glsl): u = to_u . (s, t, 1), and v = to_v . (s, t, 1).
struct TextureSlotRecord {
  vec4 to_u;  // w = bits of TEXTURE_*
  vec4 to_v;
  uvec4 image;  // x = first word of the image, y = width, z = height, w = number of levels
};
LAYOUT_CONSTANT TEXTURE_SLOT_TEXELS = 3u;
LAYOUT_CONSTANT TEXTURE_UV_SET = 1u;  // bit with the number of the set of coordinates
LAYOUT_CONSTANT TEXTURE_IS_SRGB = 2u;
LAYOUT_CONSTANT TEXTURE_MAGNIFIED_LINEARLY = 4u;
LAYOUT_CONSTANT TEXTURE_MINIFIED_LINEARLY = 8u;
LAYOUT_CONSTANT TEXTURE_HAS_LEVELS = 16u;
LAYOUT_CONSTANT TEXTURE_LEVELS_LINEAR = 32u;
LAYOUT_CONSTANT TEXTURE_SECOND_IS_SRGB = 64u;
LAYOUT_CONSTANT TEXTURE_WRAP_U_SHIFT = 8u;
LAYOUT_CONSTANT TEXTURE_WRAP_V_SHIFT = 10u;
LAYOUT_CONSTANT TEXTURE_WRAP_MASK = 3u;
LAYOUT_CONSTANT TEXTURE_STRIDE_SHIFT = 12u;  // from this bit on: log2 of the words from a texel to the next
LAYOUT_CONSTANT TEXTURE_STRIDE_MASK = 3u;
// With FEATURE_TEXTURE_BUNDLES, the number of a slot has its image's place in the bundle in its upper bits.
LAYOUT_CONSTANT TEXTURE_PLACE_SHIFT = 30u;
LAYOUT_CONSTANT TEXTURE_NUMBER_MASK = 0x3FFFFFFFu;
LAYOUT_CONSTANT WRAP_REPEAT = 0u;
LAYOUT_CONSTANT WRAP_MIRRORED = 1u;
LAYOUT_CONSTANT WRAP_CLAMP = 2u;

// Number of entries along a side of the table of lobes (shading_records.glsl) and of the table of sheens. The entries
// are stored as integers; the largest integer stands for 1.
LAYOUT_CONSTANT LOBE_TABLE_SIDE = 32u;
LAYOUT_FLOAT LARGEST_SHEEN_SHARE = 2.0f;

// Number of texels along a side of the coarsest levels of a sky (sky_levels.def, environment.glsl).
LAYOUT_CONSTANT LEAST_SKY_SIDE = 32u;

// The environment as a source of light, with FEATURE_SKY_LIGHT. Its record follows those of the lights.
LAYOUT_CONSTANT LIGHT_SKY = 6u;

struct LightRecord {
  vec4 position;   // w = 1 / range
  vec4 direction;  // the direction in which the light travels; w = cosine of a spot light's outer angle
  vec4 diffuse;    // w = 1 / max(0.001, cos inner - cos outer)
  vec4 specular;
  uvec4 kind;  // x = LIGHT_*, y = 1 if the power decreases with distance; z = bits of the size: the radius of a
               // point or spot light, the squared sine of half the angle of a directional light; 0 for a light without
               // size. Flat lights (lights/area.glsl): z = bits of the z of the direction of the width, whose x and y
               // are diffuse.w and specular.w; direction.w and position.w = half of the width and of the height.
               // LIGHT_SKY uses no other member: y = number of levels of the sky's pyramid, w = its first entry after
               // that of the sky
};
LAYOUT_CONSTANT LIGHT_TEXELS = 5u;
// A source with a table of elements, one of which a sample chooses, needs FEATURE_EMITTERS or FEATURE_CHOSEN_LIGHTS.
// In its LightRecord, kind.y is the number of elements. kind.w is the first texel of the table, counted from the
// record of the first source. position.w is a factor of the radiance of surfaces. The tables follow the records of the
// sources. An element takes two texels. In the first, x is the first number of the element's range in 0...2^32 - 1, y
// has the bits of its chance, and z is the element that contains the first number of the cell with this index. The
// second texel has an index of a primitive, or of a light's record counted from that of the first source. Its y is
// Hit::part of points on the primitive, or EMITTER_IS_LIGHT. Its w has the bits of the area. With
// FEATURE_RECT_EMITTERS each triangle is one half of a rectangle, which is the element. Its z is the number of the
// triangle's corner at which sides of the rectangle meet.
LAYOUT_CONSTANT LIGHT_EMITTERS = 7u;  // with FEATURE_RECT_EMITTERS alone, one rectangle (emitters.glsl)
LAYOUT_CONSTANT EMITTER_TEXELS = 2u;
LAYOUT_CONSTANT EMITTER_IS_LIGHT = 0xFFFFFFFFu;

// The constants of a view of a scene (uniform buffer). No branch or loop depends on them. Constants on which control
// flow depends are in Dispatch.
struct ViewConstants {
  vec4 eye;    // w = near: distance of the viewport plane
  vec4 look;   // w = width of a sample's cone at the eye, with TEXTURES
  vec4 right;  // step from one pixel to the next at distance 1 (orthographic: in the world); w = growth of the cone's
               // width
  vec4 up;
  vec4 ambient;
  vec4 background;       // w = SHOWS_*: what camera rays that leave the scene show
  vec4 backdrop_top;     // w = factor of the backdrop's colours in mirrors and behind glass
  vec4 backdrop_bottom;  // w = number of rows of the picture
  vec4 backdrop_rise;    // upward vector of length 1 / (height of the picture at distance 1) (orthographic: in the
                         // world); w = 1 for an orthographic camera
  vec4 tree_bounds;      // center and max-norm radius of the tree's primitives
  vec4 film_center;     // x, y = half the picture's size in pixels; z = radius of the lens in units of `right`; w = 1 /
                        // distance of the plane in focus
  uvec4 first_index;    // first index in its view of shading data: x = materials, y = lights, z = normals, w = colours
  uvec4 first_lookup;   // x = table of lobes, y = sky, as texels of shading data; z = side of the sky's sharpest level;
                        // w = extensions, as ExtensionRecords
  uvec4 first_texture;  // x = texture coordinates, y = tangents, z = slots, as texels of shading data; w = words of
                        // images
  uvec4 first_glass;    // x = GlassRecords; y, z = the media that contain the camera (glass.glsl); w = key of the
                        // picture's sample points (samples.glsl)
  vec4 irradiance[9];   // coefficients of the sky's light divided by pi (environment.glsl)
};

LAYOUT_FLOAT SHOWS_BACKGROUND = 0.0f;
LAYOUT_FLOAT SHOWS_SKY = 1.0f;
LAYOUT_FLOAT SHOWS_BACKDROP = 2.0f;

// The constants on which branches and loops depend, at the head of the output buffer. They are not in push constants or
// in a uniform buffer, because lavapipe would compile the shader again for each of their values.
struct Dispatch {
  uvec4 range;     // x = first block, y = one past the last, z = sample, w = mirror bounces
                   // casting: x = first ray, y = one past the last
  uvec4 window;    // x, y = first pixel; z, w = width and height in pixels
  uvec4 sampling;  // x = samples per pixel, y = bits of x of the sample's position, z = blocks per row,
                   // w = 1 for an orthographic camera
  uvec4 counts;    // x = index of the first plane's primitive, y = number of planes, z = number of lights, w =
                   // LOOP_CHECK_TURNS
  uvec4 outcome;   // casting: x = 1 after the dispatch if were_loops_cut(), otherwise 0
                   // pictures: y = largest number of rays of a sample's tree, z = bits of the smallest weight of a ray,
                   // w = bits of y of the sample's position in its pixel
};

// The state of the stream of paths for a piece of a picture. The stream follows the pixels of a film (stream.glsl).
struct StreamState {
  uvec4 place;        // x = first record, y = largest number of paths, z = sources of a turn, w = largest number of
                      // rows of workgroups
  uvec4 turn;         // x = number of the turn, -1 before the first; y, z = number of paths listed in even and odd
                      // turns; w = number of paths of this turn that have a ray
  uvec4 shadow_rays;  // x = number of listed shadow rays; y = records of a path, including its sources
  uvec4 list_groups;  // workgroups of each dispatch of the turn, in the form that Vulkan reads
  uvec4 shadow_groups;
  uvec4 path_groups;
};
// Number of uvec4 records of a path, and number of further records for each light source of a turn.
LAYOUT_CONSTANT STREAM_PATH_RECORDS = 7u;
LAYOUT_CONSTANT STREAM_SOURCE_RECORDS = 1u;
// Number of further records of a path with FEATURE_DIFFUSE_TRANSMISSION.
LAYOUT_CONSTANT STREAM_BEHIND_RECORDS = 1u;
// Number of further records of a path, and of each source of a turn, with FEATURE_SAMPLED_LIGHT.
LAYOUT_CONSTANT STREAM_SAMPLE_RECORDS = 1u;
// Number of records of a scattered path whose shadow rays are traced with it, and one more with FEATURE_TEXTURES.
LAYOUT_CONSTANT STREAM_SCATTERED_RECORDS = 4u;
// Number of further records of a path with FEATURE_GLASS, and number of further records for each waiting ray.
LAYOUT_CONSTANT STREAM_GLASS_RECORDS = 2u;
LAYOUT_CONSTANT STREAM_WAITING_RECORDS = 4u;
LAYOUT_CONSTANT STREAM_SOURCES = 16u;  // largest number of sources of a turn
LAYOUT_CONSTANT STREAM_LISTS = 2u;
LAYOUT_CONSTANT STREAM_BIN_BITS = 9u;  // bits of the bins by which rays are sorted (ray_bins.glsl)
LAYOUT_CONSTANT STREAM_BINS = 1u << STREAM_BIN_BITS;
LAYOUT_CONSTANT STREAM_LANES = 64u;
// The head of a film, before its pixels. Each shader block for the film begins with this head, under its own names.
// FilmHead on the host is the same. Each lane of a workgroup has its own counters (film.glsl).
#define FILM_HEAD(DISPATCH, STREAM, RAY_COUNTS, PASS_COUNTS) \
  Dispatch DISPATCH;                                         \
  StreamState STREAM;                                        \
  uvec4 RAY_COUNTS[BLOCK_SIZE * BLOCK_SIZE];                 \
  uvec4 PASS_COUNTS[BLOCK_SIZE * BLOCK_SIZE];
// Offset of a film's pixels in texels.
LAYOUT_CONSTANT FILM_HEAD_TEXELS = 5u + 6u + 64u + 64u;

// A number above one whose value the compiler does not know (loop_check.glsl).
LAYOUT_CONSTANT LOOP_CHECK_TURNS = 2u;

// A ray to cast. The direction may have any length. A hit has tmin < t < tmax in units of the direction.
struct RayRecord {
  vec4 origin_tmin;
  vec4 direction_tmax;
};
LAYOUT_CONSTANT RAY_TEXELS = 2u;

// The result of a ray. With FEATURE_STEP_COUNTS the counts are written too, each clamped to 16 bits. For an any-hit ray
// only a.x (0, or infinite on a miss), a.y and the counts are written.
struct HitRecord {
  uvec4 a;  // bits of t (infinite on a miss), the primitive's number in order (NO_ORDER on a miss), bits of u and v
  uvec4 b;  // bits of the geometric normal; w = node steps + primitive tests * 2^16
};
LAYOUT_CONSTANT NO_ORDER = 0xFFFFFFFFu;
// Records of crossings (crossings.comp): a record for each ray, then the records of all crossings. In a ray's record,
// a.x is the number of its crossings. With LISTS_CROSSINGS, a.y is the index of its first crossing's record and a.z the
// space for records; both are set before the dispatch. The record of a crossing is like that of a hit, but b.w is 1 if
// the ray leaves a solid, otherwise 0.

// With FEATURE_LISTED_SAMPLES each pixel of the film is a sample of a pixel of the picture. Before the sample is
// traced, x and y of its record are the bits of its position in the pixel, z is the pixel (column, and row above 16
// bits) or NO_LISTED_SAMPLE, and w is the sample's number in its pixel. Afterwards xyz is the sample's radiance.
LAYOUT_CONSTANT NO_LISTED_SAMPLE = 0xFFFFFFFFu;

// The records of a film. The records of one kind are stored together for all pixels. The first record has the sum over
// a pixel's samples, and the `order` of the visible primitive. With FEATURE_AOVS, records of the middle sample's hit
// follow.
LAYOUT_CONSTANT AOV_NORMAL = 1u;  // geometric normal; w = distance from the eye
LAYOUT_CONSTANT AOV_ALBEDO = 2u;  // w = material
LAYOUT_CONSTANT AOV_POSITION = 3u;
LAYOUT_CONSTANT AOV_SHADING_NORMAL = 4u;
LAYOUT_CONSTANT AOV_MEASURES = 5u;  // x, y = texture coordinates; z = distance along the direction of view; w = steps,
                                    // an integer
LAYOUT_CONSTANT AOV_RECORDS = 6u;
// With FEATURE_LIGHT_AOVS the parts of the sum follow:
LAYOUT_CONSTANT PART_EMISSION = 0u;      // light that the visible surface emits,
LAYOUT_CONSTANT PART_DIRECT = 1u;        // light of light sources that it reflects,
LAYOUT_CONSTANT PART_INDIRECT = 2u;      // light of its surroundings that it reflects,
LAYOUT_CONSTANT PART_REFLECTION = 3u;    // light that its mirror rays return,
LAYOUT_CONSTANT PART_TRANSMISSION = 4u;  // light that rays through it return
LAYOUT_CONSTANT PART_BACKGROUND = 5u;    // the background beside and behind surfaces; w = fraction of the pixel that
                                         // shows it
LAYOUT_CONSTANT LIGHT_PARTS = 6u;
LAYOUT_CONSTANT PART_SEEN =
    6u;  // no part of light: xyz = light of the current point without light sources, w = parts (light_parts.glsl)
LAYOUT_CONSTANT PART_RECORDS = 7u;
// With FEATURE_SAMPLE_IDS, the values of `order` of SAMPLE_IDS samples follow, four per record.
LAYOUT_CONSTANT SAMPLE_IDS = 16u;
// With FEATURE_SAMPLE_RANGES, on films without a list, the smallest and the largest value of the samples in each
// channel follow.
LAYOUT_CONSTANT RANGE_LEAST = 0u;
LAYOUT_CONSTANT RANGE_LARGEST = 1u;
LAYOUT_CONSTANT RANGE_RECORDS = 2u;
// With FEATURE_UNLIT_SHARE one more record follows: the visible unlit surfaces and backdrop, summed over samples; w is
// the number of samples that show them.

// The log of FEATURE_RAY_LOG: an entry for each ray of the path, and one (LOG_SOURCE) for each light source that may
// light its hit. Sources come before the ray whose hit they light. Rays are stored as traced: the direction's largest
// component is in [1, 2), and t is in its units.
struct RayLog {
  uvec4 ids;  // x = LOG_PATH or LOG_SOURCE; y = number of the bounce or the source; z = material; w = kind of the ray,
              // or 1 if a source has a shadow ray
  vec4 origin_tmin;
  vec4 direction_tmax;
  uvec4 hit;            // as in HitRecord::a; for a shadow ray, its first hit
  vec4 position;        // w = lift
  vec4 normal;          // geometric, as Hit::normal
  vec4 shading_normal;  // faces the ray
  vec4 weight;          // weight of the radiance along the ray; w = opacity of the hit
  vec4 own;             // ambient and emitted light
  vec4 radiance;        // the path's radiance so far, or the source's contribution
};
LAYOUT_CONSTANT LOG_PATH = 0u;
LAYOUT_CONSTANT LOG_SOURCE = 1u;
// The kind of a path's ray.
LAYOUT_CONSTANT LOG_CAMERA = 0u;
LAYOUT_CONSTANT LOG_REFLECTION = 1u;
LAYOUT_CONSTANT LOG_REFRACTION = 2u;
LAYOUT_CONSTANT LOG_THROUGH = 3u;  // the continuation of a ray behind a surface that blends

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
