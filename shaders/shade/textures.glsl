// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Textures (docs/model.md, "Textures"). Filtering is written out in an order that drivers must not change, because
// samplers differ in some bits of the position between two texels. A ray's cone determines the size of a pixel on a
// surface (Akenine-Moller and others, "Texture Level of Detail Strategies for Real-Time Ray Tracing", Ray Tracing Gems
// ch. 20).

layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer ImageWords { uint image_words[]; };
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Slots { TextureSlotRecord slots[]; };
layout(set = 0, binding = BINDING_TEXTURE_TEXELS) uniform usamplerBuffer image_texels;

uint load_image_word(uint index) {
  if (FETCHES_TEXELS == 0u) return image_words[VIEW.first_texture.w + index];
  return texelFetch(image_texels, int(index)).x;
}

// Returns the record of a slot. Numbers of slots start at 1. With FEATURE_TEXTURE_BUNDLES, their upper bits are the
// place of the image in its bundle.
TextureSlotRecord load_slot(uint number) {
  uint index = VIEW.first_texture.z + (has(FEATURE_TEXTURE_BUNDLES) ? number & TEXTURE_NUMBER_MASK : number) - 1u;
  if (FETCHES_TEXELS == 0u) return slots[index];
  uint first = TEXTURE_SLOT_TEXELS * index;
  return TextureSlotRecord(shading_vector(first), shading_vector(first + 1u),
                           texelFetch(shading_texels, int(first + 2u)));
}

uint place_in_bundle(uint number) { return has(FEATURE_TEXTURE_BUNDLES) ? number >> TEXTURE_PLACE_SHIFT : 0u; }

uint flags_of(TextureSlotRecord slot) { return floatBitsToUint(slot.to_u.w); }
uint wrap_of(TextureSlotRecord slot, uint shift) { return (flags_of(slot) >> shift) & TEXTURE_WRAP_MASK; }
bool has_flag(TextureSlotRecord slot, uint flag) { return (flags_of(slot) & flag) != 0u; }
uint stride_shift_of(TextureSlotRecord slot) { return (flags_of(slot) >> TEXTURE_STRIDE_SHIFT) & TEXTURE_STRIDE_MASK; }
// Returns whether the image at a place of the slot's bundle has sRGB colours. Only the first two may have them.
bool is_srgb(TextureSlotRecord slot, uint place) {
  if (!has(FEATURE_TEXTURE_BUNDLES)) return has_flag(slot, TEXTURE_IS_SRGB);
  return has_flag(slot, place == 0u ? TEXTURE_IS_SRGB : (place == 1u ? TEXTURE_SECOND_IS_SRGB : 0u));
}

// Returns log2 of a positive number with an error of at most 1e-3, which is a thousandth of a level.
float log2_about(float x) {
  uint bits = floatBitsToUint(x);
  precise float m = uintBitsToFloat((bits & 0x007FFFFFu) | 0x3F800000u);
  precise float series = -2.153620718 + m * (3.047884161 + m * (-1.051875031 + m * 0.158248767));
  precise float result = float(int(bits >> 23) - 127) + series;
  return result;
}

// Returns the linear light of an sRGB value (code / 255), accurate to 0.006 of a code's step.
vec3 decode_srgb(vec3 code) {
  precise vec3 s = sqrt((code + 0.055) * (1.0 / 1.055));
  precise vec3 s2 = s * s;
  precise vec3 curve =
      s2 * s2 * (0.04322932 + s * (1.266557 + s * (-0.5534927 + s * (0.3362242 - 0.09251754 * s))));
  precise vec3 line = code * (1.0 / 12.92);
  return vec3(code.x <= 0.04045 ? line.x : curve.x, code.y <= 0.04045 ? line.y : curve.y,
              code.z <= 0.04045 ? line.z : curve.z);
}

// Returns the coordinate, wrapped to 0...1.
float wrap(float x, uint mode) {
  precise float repeated = x - floor(x);
  precise float twice = x - 2.0 * floor(0.5 * x);
  precise float mirrored = twice > 1.0 ? 2.0 - twice : twice;
  return mode == WRAP_REPEAT ? repeated : (mode == WRAP_MIRRORED ? mirrored : clamp(x, 0.0, 1.0));
}

// Returns the index of a texel inside the image for an index that is at most one beyond the edge.
uint wrap_texel(int i, uint count, uint mode) {
  int last = int(count) - 1;
  int other_side = i < 0 ? last : (i > last ? 0 : i);
  return uint(mode == WRAP_REPEAT ? other_side : clamp(i, 0, last));
}

// The texels of a level around a point: the words of the image, or of the first image of its bundle.
struct Footprint {
  uint nearest;
  uint right;
  uint below;
  uint across;
  vec2 part;  // weights of the right and of the lower texels
};

// Returns the texels around `uv`. Without `is_linear`, `nearest` contains `uv`, and the others have no weight.
Footprint find_texels(TextureSlotRecord slot, uint level, vec2 uv, bool is_linear) {
  uint wrap_u = wrap_of(slot, TEXTURE_WRAP_U_SHIFT);
  uint wrap_v = wrap_of(slot, TEXTURE_WRAP_V_SHIFT);
  uint start = slot.image.x + load_image_word(slot.image.x + level);
  uvec2 size = max(slot.image.yz >> level, uvec2(1u));
  vec2 wrapped = vec2(wrap(uv.x, wrap_u), wrap(uv.y, wrap_v));
  precise vec2 place = wrapped * vec2(size) - (is_linear ? 0.5 : 0.0);
  vec2 corner = floor(place);
  ivec2 first = ivec2(corner);
  precise vec2 part = is_linear ? place - corner : vec2(0.0);
  uint shift = has(FEATURE_TEXTURE_BUNDLES) ? stride_shift_of(slot) : 0u;
  uint left = start + (wrap_texel(first.x, size.x, wrap_u) << shift);
  uint right = start + (wrap_texel(first.x + 1, size.x, wrap_u) << shift);
  uint upper = (wrap_texel(first.y, size.y, wrap_v) * size.x) << shift;
  uint lower = (wrap_texel(first.y + 1, size.y, wrap_v) * size.x) << shift;
  return Footprint(left + upper, right + upper, left + lower, right + lower, part);
}

vec4 decode_texel(uint word, bool is_srgb) {
  precise vec4 numbers = vec4((uvec4(word) >> uvec4(0u, 8u, 16u, 24u)) & 0xFFu) * (1.0 / 255.0);
  if (is_srgb) numbers.xyz = decode_srgb(numbers.xyz);
  return numbers;
}

// Returns the bilinear interpolation of four texels: the nearest, right, below and across.
vec4 filter_texels(uvec4 words, vec2 part, bool is_srgb) {
  vec4 nearest = decode_texel(words.x, is_srgb);
  vec4 right = decode_texel(words.y, is_srgb);
  vec4 below = decode_texel(words.z, is_srgb);
  vec4 across = decode_texel(words.w, is_srgb);
  precise vec4 upper = nearest + part.x * (right - nearest);
  precise vec4 lower = below + part.x * (across - below);
  precise vec4 result = upper + part.y * (lower - upper);
  return result;
}

// The texture coordinates of a surface point, for looking up textures.
struct TexturePlace {
  vec4 uvs;           // coordinates of both sets
  vec2 log_coverage;  // for each set, log2 of the area of coordinates that a pixel covers
};

// Both sets of texture coordinates at a triangle's corners.
struct CornerUvs {
  vec4 a;
  vec4 b;
  vec4 c;
};

CornerUvs load_corner_uvs(uvec3 corners) {
  return CornerUvs(load_vertex4(VIEW.first_texture.x + corners.x), load_vertex4(VIEW.first_texture.x + corners.y),
                   load_vertex4(VIEW.first_texture.x + corners.z));
}

// Returns the area of the triangle in texture coordinates, divided by its area in space. The arguments are the
// coordinates at its corners.
float coordinates_per_area(vec2 a, vec2 b, vec2 c, float area) {
  precise vec2 ab = b - a;
  precise vec2 ac = c - a;
  precise float double_area = abs(ab.x * ac.y - ab.y * ac.x);
  precise float ratio = double_area / max(area, SMALLEST_NORMAL);
  return ratio;
}

// Returns the place for a point of a triangle. `facing` is the cosine between its normal and the ray, `cone_width` the
// width of the ray's cone.
TexturePlace texture_place(Primitive p, CornerUvs corners, vec3 weights, float facing, float cone_width) {
  precise vec4 uvs = weights.x * corners.a + weights.y * corners.b + weights.z * corners.c;
  precise vec3 e1 = corner1(p) - corner0(p);
  precise vec3 e2 = corner2(p) - corner0(p);
  float area = length3(cross3(e1, e2));
  // If the ray hits the surface at an angle, the cone covers an ellipse. The code uses the mean of the logarithms of
  // its axes.
  precise float footprint = max(cone_width * cone_width, SMALLEST_NORMAL) / max(abs(facing), 1.0 / 64.0);
  precise vec2 coverage = footprint * vec2(coordinates_per_area(corners.a.xy, corners.b.xy, corners.c.xy, area),
                                           coordinates_per_area(corners.a.zw, corners.b.zw, corners.c.zw, area));
  return TexturePlace(uvs, vec2(log2_about(max(coverage.x, SMALLEST_NORMAL)),
                                log2_about(max(coverage.y, SMALLEST_NORMAL))));
}

// The level of a texture whose texels have the size of the pixel, and the weight of the next level.
struct LevelChoice {
  uint first;
  uint end;
  float part;  // weight of the second level
  bool is_linear;
};

// If levels are interpolated and a pixel has at least four samples, each sample uses only one level. The mean of the
// samples is then that of both levels.
LevelChoice choose_levels(TextureSlotRecord slot, float log_coverage) {
  precise float scale = abs(slot.to_u.x * slot.to_v.y - slot.to_u.y * slot.to_v.x);
  precise float texels = max(scale * float(slot.image.y) * float(slot.image.z), SMALLEST_NORMAL);
  precise float level = 0.5 * (log_coverage + log2_about(texels));
  bool is_magnified = !(level > 0.0);
  bool is_linear = has_flag(slot, is_magnified ? TEXTURE_MAGNIFIED_LINEARLY : TEXTURE_MINIFIED_LINEARLY);
  if (is_magnified || !has_flag(slot, TEXTURE_HAS_LEVELS)) return LevelChoice(0u, 1u, 0.0, is_linear);
  bool are_levels_linear = has_flag(slot, TEXTURE_LEVELS_LINEAR);
  bool takes_one = !are_levels_linear || samples_per_pixel() >= 4u;
  precise float shift = are_levels_linear ? (float(sample_at_hand()) + 0.5) / float(samples_per_pixel()) : 0.5;
  float last = float(slot.image.w - 1u);
  precise float at = min(level, last);
  float first = floor(takes_one ? min(at + shift, last) : at);
  precise float part = at - first;
  return LevelChoice(uint(first), uint(first) + (takes_one || first >= last ? 1u : 2u), part, is_linear);
}

// The lookup of a slot's texture at a place.
struct Lookup {
  TextureSlotRecord slot;
  vec2 uv;
  LevelChoice levels;
};

Lookup lookup_of(uint number, TexturePlace place) {
  TextureSlotRecord slot = load_slot(number);
  bool is_second = has_flag(slot, TEXTURE_UV_SET);
  vec2 st = is_second ? place.uvs.zw : place.uvs.xy;
  precise vec2 uv = vec2(slot.to_u.x * st.x + slot.to_u.y * st.y + slot.to_u.z,
                         slot.to_v.x * st.x + slot.to_v.y * st.y + slot.to_v.z);
  return Lookup(slot, uv, choose_levels(slot, is_second ? place.log_coverage.y : place.log_coverage.x));
}

// Returns the mix of the earlier levels with the level that was just looked up.
vec4 mix_level(Lookup lookup, uint level, vec4 first, vec4 seen) {
  precise vec4 between = first + lookup.levels.part * (seen - first);
  return level == lookup.levels.first ? seen : between;
}

// Returns the value of a slot at a place. The number of the slot is not 0.
vec4 look_up(uint number, TexturePlace place) {
  Lookup lookup = lookup_of(number, place);
  uint image = place_in_bundle(number);
  vec4 result = vec4(0.0);
  uint level = lookup.levels.first;
  do {
    if (level < lookup.levels.end) {
      Footprint texels = find_texels(lookup.slot, level, lookup.uv, lookup.levels.is_linear);
      uvec4 words = uvec4(load_image_word(texels.nearest + image), load_image_word(texels.right + image),
                          load_image_word(texels.below + image), load_image_word(texels.across + image));
      vec4 seen = filter_texels(words, texels.part, is_srgb(lookup.slot, image));
      result = mix_level(lookup, level, result, seen);
      ++level;
    }
  } while (level < lookup.levels.end);
  return result;
}

// The values of the images of a bundle at a point. Images that stand alone are the first of their bundle.
struct BundleValues {
  vec4 first;
  vec4 second;
  vec4 third;
  vec4 fourth;
};

// Returns a texel of all images of a bundle, whose words lie side by side.
uvec4 load_bundle(uint index) {
  if (FETCHES_TEXELS == 0u) {
    uint word = VIEW.first_texture.w + index;
    return uvec4(image_words[word], image_words[word + 1u], image_words[word + 2u], image_words[word + 3u]);
  }
  uvec4 words = texelFetch(shading_texels, int((VIEW.first_texture.w + index) >> 2));
  // The texels of an image that stands alone, or of two images, begin at any, or any second, of the four words.
  uint start = index & 3u;
  uint word = start < 2u ? (start == 0u ? words.x : words.y) : (start == 2u ? words.z : words.w);
  return uvec4(word, start == 2u ? words.w : words.y, words.z, words.w);
}

// Returns the values of a slot's bundle at a level.
BundleValues filter_bundle(Lookup lookup, uint level) {
  Footprint texels = find_texels(lookup.slot, level, lookup.uv, lookup.levels.is_linear);
  BundleValues seen;
  if (!has(FEATURE_TEXTURE_BUNDLES)) {
    uvec4 words = uvec4(load_image_word(texels.nearest), load_image_word(texels.right), load_image_word(texels.below),
                        load_image_word(texels.across));
    seen.first = filter_texels(words, texels.part, is_srgb(lookup.slot, 0u));
    return seen;
  }
  uvec4 nearest = load_bundle(texels.nearest);
  uvec4 right = load_bundle(texels.right);
  uvec4 below = load_bundle(texels.below);
  uvec4 across = load_bundle(texels.across);
  seen.first = filter_texels(uvec4(nearest.x, right.x, below.x, across.x), texels.part, is_srgb(lookup.slot, 0u));
  seen.second = filter_texels(uvec4(nearest.y, right.y, below.y, across.y), texels.part, is_srgb(lookup.slot, 1u));
  seen.third = filter_texels(uvec4(nearest.z, right.z, below.z, across.z), texels.part, false);
  seen.fourth = filter_texels(uvec4(nearest.w, right.w, below.w, across.w), texels.part, false);
  return seen;
}

// Returns the values of all images of a slot's bundle at a place.
BundleValues look_up_bundle(uint number, TexturePlace place) {
  Lookup lookup = lookup_of(number, place);
  BundleValues result;
  result.first = vec4(0.0);
  if (has(FEATURE_TEXTURE_BUNDLES)) result = BundleValues(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
  uint level = lookup.levels.first;
  do {
    if (level < lookup.levels.end) {
      BundleValues seen = filter_bundle(lookup, level);
      result.first = mix_level(lookup, level, result.first, seen.first);
      if (has(FEATURE_TEXTURE_BUNDLES)) {
        result.second = mix_level(lookup, level, result.second, seen.second);
        result.third = mix_level(lookup, level, result.third, seen.third);
        result.fourth = mix_level(lookup, level, result.fourth, seen.fourth);
      }
      ++level;
    }
  } while (level < lookup.levels.end);
  return result;
}

// Returns whether one look-up finds the values of both slots.
bool are_bundled(uint number, uint other) {
  return has(FEATURE_TEXTURE_BUNDLES) ? ((number ^ other) & TEXTURE_NUMBER_MASK) == 0u : number == other;
}

// Returns a slot's value among those of its bundle.
vec4 value_of(uint number, BundleValues values) {
  if (!has(FEATURE_TEXTURE_BUNDLES)) return values.first;
  uint place = place_in_bundle(number);
  vec4 low = place == 0u ? values.first : values.second;
  vec4 high = place == 2u ? values.third : values.fourth;
  return place < 2u ? low : high;
}

uint slot_number(float bits) { return floatBitsToUint(bits); }
