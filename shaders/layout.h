// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What host and shaders share: one definition that both compilers read. Members are vec4 and uvec4 alone, so that
// C++, std140 and std430 agree; tests/gpu/layout_test.cpp holds the offsets against the SPIR-V.
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
#else
#define LAYOUT_CONSTANT const uint
#endif

// What a scene may use; a pipeline is specialised to the mask of what it does use. Names for people: features.cpp.
LAYOUT_CONSTANT FEATURE_TRIANGLES = 1u << 0;
LAYOUT_CONSTANT FEATURE_SPHERES = 1u << 1;
LAYOUT_CONSTANT FEATURE_CYLINDERS = 1u << 2;
LAYOUT_CONSTANT FEATURE_CONES = 1u << 3;
LAYOUT_CONSTANT FEATURE_PLANES = 1u << 4;
LAYOUT_CONSTANT FEATURE_POINT_LIGHTS = 1u << 5;
LAYOUT_CONSTANT FEATURE_DIRECTIONAL_LIGHTS = 1u << 6;
LAYOUT_CONSTANT FEATURE_SPOT_LIGHTS = 1u << 7;
LAYOUT_CONSTANT FEATURE_FALLOFF = 1u << 8;
LAYOUT_CONSTANT FEATURE_SHADOWS = 1u << 9;
LAYOUT_CONSTANT FEATURE_SPECULAR = 1u << 10;
LAYOUT_CONSTANT FEATURE_MIRRORS = 1u << 11;
LAYOUT_CONSTANT FEATURE_SMOOTH_NORMALS = 1u << 12;
LAYOUT_CONSTANT FEATURE_VERTEX_COLORS = 1u << 13;
LAYOUT_CONSTANT FEATURE_HEADLIGHT = 1u << 14;
LAYOUT_CONSTANT FEATURE_COUNT = 15u;
// What a caller may ask of a pipeline whatever the scene. Three bits hold what a picture shows, SHADING_*.
LAYOUT_CONSTANT SHADING_SHIFT = 26u;
LAYOUT_CONSTANT SHADING_MASK = 7u;
LAYOUT_CONSTANT FEATURE_RAY_LOG = 1u << 29;      // each ray and source of one pixel: RayLog
LAYOUT_CONSTANT FEATURE_AOVS = 1u << 30;         // depth, normal and id of each pixel
LAYOUT_CONSTANT FEATURE_STEP_COUNTS = 1u << 31;  // node steps and primitive tests of each ray

// Kinds of primitive that live in the tree, and of light.
LAYOUT_CONSTANT KIND_TRIANGLE = 0u;
LAYOUT_CONSTANT KIND_SPHERE = 1u;
LAYOUT_CONSTANT KIND_CYLINDER = 2u;
LAYOUT_CONSTANT KIND_CONE = 3u;
LAYOUT_CONSTANT KIND_PLANE = 4u;
LAYOUT_CONSTANT LIGHT_POINT = 0u;
LAYOUT_CONSTANT LIGHT_DIRECTIONAL = 1u;
LAYOUT_CONSTANT LIGHT_SPOT = 2u;
LAYOUT_CONSTANT LIGHT_HEADLIGHT = 3u;

// What a picture shows: light, or what debug shadings do (debug_shading.glsl).
LAYOUT_CONSTANT SHADING_FULL = 0u;
LAYOUT_CONSTANT SHADING_NORMALS = 1u;
LAYOUT_CONSTANT SHADING_UV = 2u;
LAYOUT_CONSTANT SHADING_OBJECT = 3u;
LAYOUT_CONSTANT SHADING_PRIMITIVE = 4u;
LAYOUT_CONSTANT SHADING_DEPTH = 5u;
LAYOUT_CONSTANT SHADING_STEPS = 6u;
// Steps at which the heat map of SHADING_STEPS is white.
LAYOUT_CONSTANT HEAT_STEPS = 64u;

// Descriptor bindings; Vulkan's required minimum is four storage buffers a stage.
LAYOUT_CONSTANT BINDING_FRAME = 0u;
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

// Specialisation constants.
LAYOUT_CONSTANT CONSTANT_FEATURES = 0u;
LAYOUT_CONSTANT CONSTANT_STACK_SIZE = 1u;
LAYOUT_CONSTANT CONSTANT_ANY_HIT = 2u;
LAYOUT_CONSTANT CONSTANT_FETCHES_TEXELS = 3u;
LAYOUT_CONSTANT CONSTANT_PACKET_SIZE = 4u;

// A workgroup traces a block of BLOCK_SIZE x BLOCK_SIZE pixels, one a lane (128 invocations are guaranteed).
LAYOUT_CONSTANT BLOCK_SIZE = 8u;

// Up to four children with their boxes in bytes: a plane of a box lies at origin + byte * 2^(exponent - 127), each axis
// with an exponent of its own. The four bytes of a word are the four children's, the first the lowest.
// A child that is an inner node is its index. A leaf has CHILD_IS_LEAF, its count - 1 in the four bits below, and its
// first primitive in the rest.
struct Node {
  uvec4 frame;     // bits of the origin; w = exponents of x, y, z, the lowest byte first, then how many children
  uvec4 lo;        // of x, y, z; w = hi of x
  uvec4 hi;        // of y, z; 0, 0
  uvec4 children;  // 0 beyond the last
};
LAYOUT_CONSTANT NODE_WIDTH = 4u;
LAYOUT_CONSTANT CHILD_IS_LEAF = 0x80000000u;
LAYOUT_CONSTANT CHILD_COUNT_SHIFT = 27u;
LAYOUT_CONSTANT CHILD_FIRST_MASK = 0x07FFFFFFu;
// Traversal keeps a node's index in 24 bits (traversal.glsl, NO_FAMILY).
LAYOUT_CONSTANT MAX_NODES = 0x00FFFFFFu;

// One primitive in leaf order; planes follow after those of the tree.
//   triangle  a = corner 0, corner 1 x   b = corner 1 yz, corner 2 xy    c.x = bits of corner 2 z
//   sphere    a = center, radius
//   cylinder  a = center, radius         b = axis, half height
//   cone      a = center, bottom radius  b = axis, half height           c.x = bits of the top radius
//   plane     a = point                  b = normal
// c.y is the scene-wide number in (object, primitive) order, which breaks ties; c.z the kind; c.w hashes of the object,
// in the lower 16 bits, and of the primitive, which debug shadings make colours of.
struct Primitive {
  vec4 a;
  vec4 b;
  uvec4 c;
};

// What shading needs of the primitive at the same index: xyz = the corners' vertex indices (triangles with vertex
// normals or colours), w = material index and SURFACE_* bits.
struct SurfaceRecord {
  uvec4 corners_material;
};
LAYOUT_CONSTANT SURFACE_IS_SMOOTH = 0x80000000u;
LAYOUT_CONSTANT SURFACE_IS_COLORED = 0x40000000u;
LAYOUT_CONSTANT SURFACE_MATERIAL_MASK = 0x3FFFFFFFu;

struct MaterialRecord {
  vec4 ambient;
  vec4 diffuse;
  vec4 specular;  // w = shininess
  vec4 reflection;
  vec4 emissive;
};

struct LightRecord {
  vec4 position;   // w = 1 / range
  vec4 direction;  // the light travels so; w = cosine of a spot's outer angle
  vec4 diffuse;    // w = 1 / max(0.001, cos inner - cos outer)
  vec4 specular;
  uvec4 kind;  // x = LIGHT_*, y = 1 if it falls off with distance
};

// A picture's constants (uniform buffer). None of them decides a branch or a loop: see Dispatch.
struct Frame {
  vec4 eye;  // w = near: distance of the viewport plane
  vec4 look;
  vec4 right;  // from one pixel to the next on the projection plane at distance 1 (orthographic: in the world)
  vec4 up;
  vec4 ambient;
  vec4 background;
  vec4 tree_bounds;   // center and max-norm radius of everything in the tree
  vec4 film_center;   // x, y = half the picture's size in pixels; z = 1 / (2 * samples)
  uvec4 first_index;  // of x = materials, y = lights, z = normals, w = colours in their views of the shading buffer
};

// What decides branches and loops, at the head of the buffer that is written: not in push constants or a uniform
// buffer, because lavapipe compiles the shader anew for each value of those that control flow depends on.
struct Dispatch {
  uvec4 range;     // x = first block, y = one past the last, z = sample, w = mirror bounces
                   // casting: x = first ray, y = one past the last
  uvec4 window;    // x, y = first pixel; z, w = width and height in pixels
  uvec4 sampling;  // x = samples a pixel, y = lattice generator, z = blocks a row, w = 1 for an orthographic camera
  uvec4 counts;    // x = index of the first plane's primitive, y = planes, z = lights, w = LOOP_CHECK_TURNS
  uvec4 outcome;   // casting: x = 1 after the dispatch if were_loops_cut(); 0 else
  uvec4 queue;     // of paths from one stage to the next: x = its first record, y = paths put, z = paths taken,
                   // w = paths that a lane takes at most
};

// More than one, and not known to the compiler (loop_check.glsl).
LAYOUT_CONSTANT LOOP_CHECK_TURNS = 2u;

// A ray to cast: the direction has any length, a hit has tmin < t < tmax in its units.
struct RayRecord {
  vec4 origin_tmin;
  vec4 direction_tmax;
};

// What it meets. FEATURE_STEP_COUNTS brings the counts, each clamped to its 16 bits. Who asks for any hit is told a.x,
// 0 or infinite on a miss, and a.y, and without the counts nothing else is written.
struct HitRecord {
  uvec4 a;  // bits of t (infinite on a miss), the primitive's number in order (NO_ORDER on a miss), bits of u and v
  uvec4 b;  // bits of the geometric normal; w = node steps + primitive tests * 2^16
};
LAYOUT_CONSTANT NO_ORDER = 0xFFFFFFFFu;

// What FEATURE_RAY_LOG keeps of a ray of the path, or of a source that may light its hit: LOG_SOURCE. Sources come
// before the ray whose hit they light. Rays are as traced: the direction's largest component is in [1, 2), and t in
// its units.
struct RayLog {
  uvec4 ids;  // x = LOG_*; y = the bounce or the source; z = the material; w = 1 where a source has a shadow ray
  vec4 origin_tmin;
  vec4 direction_tmax;
  uvec4 hit;            // as HitRecord::a; of a shadow ray, of what it met first
  vec4 position;        // w = lift
  vec4 normal;          // geometric, as Hit::normal
  vec4 shading_normal;  // faces the ray
  vec4 weight;          // by which what the hit sends counts
  vec4 own;             // ambient and emitted light
  vec4 radiance;        // the path's so far; a source's contribution
};
LAYOUT_CONSTANT LOG_PATH = 0u;
LAYOUT_CONSTANT LOG_SOURCE = 1u;

#ifdef __cplusplus
static_assert(sizeof(RayLog) == 160);
static_assert(sizeof(RayRecord) == 32 && sizeof(HitRecord) == 32);
static_assert(sizeof(Node) == 64 && sizeof(Primitive) == 48 && sizeof(SurfaceRecord) == 16);
static_assert(sizeof(MaterialRecord) == 80 && sizeof(LightRecord) == 80 && sizeof(Frame) == 144);
static_assert(sizeof(Dispatch) == 96);
#undef LAYOUT_CONSTANT
}  // namespace promin::layout
#endif
#endif
