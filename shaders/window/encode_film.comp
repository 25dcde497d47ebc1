// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Encodes a film's pixels for a window as for PNG files: divides the sum over samples by their number, applies exposure
// and tone mapping, and encodes to 8-bit sRGB.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "shared/layout.h"

layout(local_size_x = BLOCK_SIZE * BLOCK_SIZE) in;

// The display transform: TONE_MAPPING_*.
layout(constant_id = 0) const uint TONE_MAPPING = 0u;
layout(constant_id = 2) const uint DITHERS = 0u;
// True if the film has FEATURE_UNLIT_SHARE.
layout(constant_id = 3) const uint HAS_UNLIT = 0u;

// This is the buffer of film.glsl. Its head was written by the picture's last dispatch.
layout(std430, set = 0, binding = BINDING_FILM) readonly buffer Film {
  FILM_HEAD(dispatch, film_stream, ray_counts, pass_counts)
  uvec4 pixels[];
};

#include "shared/dispatch.glsl"
#include "window/tone_mapping.glsl"
#include "window/dither.glsl"
layout(std430, set = 0, binding = 0) writeonly buffer Encoded { uint encoded[]; };
// The factor of the exposure. The window can change it without another pipeline.
layout(std430, set = 0, binding = 1) readonly buffer Exposure { float exposure_factor; };

vec3 encode_srgb(vec3 linear) {
  vec3 x = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

// Returns the displayed light of a pixel. `unlit` is the light of its unlit surfaces; w is the fraction of the pixel
// that they cover.
vec3 shown_light(vec3 radiance, vec4 unlit) {
  float exposure = exposure_factor;
  float lit = max(1.0 - unlit.w, 0.0);
  if (unlit.w == 0.0) return map_tones(TONE_MAPPING, exposure * radiance);
  if (lit == 0.0) return unlit.xyz;
  return lit * map_tones(TONE_MAPPING, exposure * (radiance - unlit.xyz) / lit) + unlit.xyz;
}

void main() {
  uint count = window_pixel_count();
  float samples = float(samples_per_pixel());
  uint stride = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
  for (uint i = gl_GlobalInvocationID.x; i < count; i += stride) {
    vec3 radiance = uintBitsToFloat(pixels[i].xyz) / samples;
    vec4 unlit = HAS_UNLIT != 0u ? uintBitsToFloat(pixels[count + i]) / samples : vec4(0.0);
    vec3 codes = 255.0 * encode_srgb(shown_light(radiance, unlit));
    if (DITHERS != 0u) {
      uvec2 pixel = uvec2(i % window_size().x, i / window_size().x);
      codes = vec3(dithered(codes.x, pixel, 0u), dithered(codes.y, pixel, 1u), dithered(codes.z, pixel, 2u));
    }
    encoded[i] = packUnorm4x8(vec4(codes / 255.0, 1.0));
  }
}
