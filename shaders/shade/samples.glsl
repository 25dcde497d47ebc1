// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The sample points of lights with a size and of the lens (docs/model.md, "Sample points"). A point depends only on the
// pixel's place in the whole picture, the seed, the number of the sample in the pixel, and the number of the pair of
// dimensions. It is computed with integers only.

// True if some points are sampled. The first pair is the lens's if there is one. Then there is a pair for each source of
// each bounce.
const uint HAS_SAMPLE_POINTS = FEATURE_BIT(FEATURE_SAMPLED_LIGHT) | FEATURE_BIT(FEATURE_LENS);
const uint FIRST_LIGHT_PAIR = FEATURE_BIT(FEATURE_LENS);

// The sample whose points are requested: the key of its pixel, its number in the pixel, and the pair of dimensions. Set
// by choose_sample().
uint sample_key;
uint sample_number;
uint sample_pair;

// The point of the unit square for which sample_light() returns a point of a light with a size. Set by sample_light() or
// by sample_light_or_lobe().
vec2 sample_u;

void choose_sample(uvec2 id, uint pair) {
  sample_key = id.x;
  sample_number = id.y;
  sample_pair = pair;
}

// An integer hash, the same as engine/core/hash.h.
uint mix_bits(uint x) {
  x ^= x >> 16;
  x *= 0x7FEB352Du;
  x ^= x >> 15;
  x *= 0x846CA68Bu;
  return x ^ (x >> 16);
}

// Returns the key of a pixel at this place in the whole picture.
uint key_of_pixel(uvec2 pixel) { return mix_bits(pixel.x + mix_bits(pixel.y + VIEW.first_glass.w)); }

// Permutes the bits of x so that each bit of the result depends only on lower bits of x (Laine and Karras, "Stratified
// Sampling for Stochastic Transparency", 2011, with Burley's constants).
uvec2 permute_upwards(uvec2 x, uvec2 seeds) {
  x += seeds;
  x ^= x * 0x6C50B47Cu;
  x ^= x * 0xB82F1E52u;
  x ^= x * 0xC7AFE638u;
  x ^= x * 0x8D22F6E6u;
  return x;
}

// Returns the numbers of Sobol's first two dimensions with reversed bits. The second matrix is Pascal's triangle mod 2,
// so the sum for a bit is over the supersets of its index.
uvec2 first_sobols(uint index) {
  uint x = index;
  x ^= (x >> 1) & 0x55555555u;
  x ^= (x >> 2) & 0x33333333u;
  x ^= (x >> 4) & 0x0F0F0F0Fu;
  x ^= (x >> 8) & 0x00FF00FFu;
  x ^= x >> 16;
  return uvec2(index, x);
}

// Returns the index of the first pair's point for a sample of a pixel with an error target: a linear map of the bits of
// the sample's number (docs/model.md, "Sample points").
uint joint_index(uint number) {
  uint index = number & 0xFFFFFC03u;
#define PROMIN_JOIN(BIT, COLUMN) index ^= (0u - ((number >> BIT) & 1u)) & COLUMN
  PROMIN_JOIN(2u, 6u);
  PROMIN_JOIN(3u, 13u);
  PROMIN_JOIN(4u, 27u);
  PROMIN_JOIN(5u, 45u);
  PROMIN_JOIN(6u, 111u);
  PROMIN_JOIN(7u, 188u);
  PROMIN_JOIN(8u, 274u);
  PROMIN_JOIN(9u, 687u);
#undef PROMIN_JOIN
  return index;
}

// Returns the point of the chosen pair as fractions of 2^32. sample_pair_point() rounds it to odd multiples of 2^-24 in
// each coordinate. The first 2^m points of a pair are a (0, m, 2)-net. All pairs have Sobol's first two dimensions, in
// an order of their own. The order of the first pair with FEATURE_LISTED_SAMPLES is the one that suits the positions in
// the pixel, which have the same dimensions.
uvec2 sample_pair_bits() {
  uint seed = mix_bits(sample_key + 3u * sample_pair);
  uvec2 seeds = uvec2(mix_bits(seed + 1u), mix_bits(seed + 2u));
  uint shuffled = bitfieldReverse(permute_upwards(uvec2(bitfieldReverse(sample_number)), uvec2(seed)).x);
  if (has(FEATURE_LISTED_SAMPLES)) shuffled = sample_pair == 0u ? joint_index(sample_number) : shuffled;
  return bitfieldReverse(permute_upwards(first_sobols(shuffled), seeds));
}

vec2 unit_square_point(uvec2 bits) {
  precise vec2 point = vec2(bits >> 9) * 1.1920928955078125e-7 + 5.9604644775390625e-8;
  return point;
}

vec2 sample_pair_point() { return unit_square_point(sample_pair_bits()); }

// Maps a point of the unit square to the unit disc; areas stay in proportion (Shirley and Chiu, "A Low Distortion Map
// Between Disk and Square", 1997). Returns the position, and in z the squared distance from the centre.
vec3 point_on_disc(vec2 u) {
  precise vec2 v = 2.0 * u - 1.0;
  bool is_steep = abs(v.x) < abs(v.y);
  float radius = is_steep ? v.y : v.x;
  precise float angle = 0.785398163 * ((is_steep ? v.x : v.y) / radius);
  float sine = short_sine(angle);
  float cosine = short_cosine(angle);
  precise vec3 point = vec3(radius * (is_steep ? sine : cosine), radius * (is_steep ? cosine : sine), radius * radius);
  return point;
}

// Returns two unit vectors at right angles to a unit axis and to each other.
void make_frame(vec3 axis, out vec3 across, out vec3 along) {
  across = normalize3(cross3(axis, abs(axis.x) < 0.57 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
  along = cross3(axis, across);
}

// A direction in a cone.
struct ConeSample {
  vec3 direction;  // unit
  float below;     // 1 minus the cosine of its angle to the axis
};

// Chooses a direction in the cone about a unit axis, with uniform density over its solid angle. `cap` is 1 minus the
// cosine of half its angle, at most 2.
ConeSample sample_cone(vec3 axis, float cap) {
  vec3 disc = point_on_disc(sample_u);
  // Lambert's azimuthal projection maps the disc to the cap of the unit sphere; areas stay in proportion.
  precise float below = cap * disc.z;
  precise float scale = sqrt(cap * (2.0 - below));
  vec3 across;
  vec3 along;
  make_frame(axis, across, along);
  precise vec3 direction = scale * (disc.x * across + disc.y * along) + (1.0 - below) * axis;
  return ConeSample(direction, below);
}
