// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Shows an encoded film (encode_film.comp) in a window of any size. It interpolates between the film's pixels; if the
// window has the same size, each pixel shows its own.
#version 450

// 1 for surfaces that receive linear values and encode them themselves.
layout(constant_id = 0) const uint DECODES = 0u;

layout(std430, set = 0, binding = 0) readonly buffer Encoded { uint encoded[]; };

layout(push_constant) uniform Display {
  uvec4 size;  // x, y = size of the film in pixels
  vec4 scale;  // x, y = pixels of the film per pixel of the window
} display;

layout(location = 0) out vec4 color;

vec3 decode_srgb(vec3 x) {
  return mix(pow((x + 0.055) / 1.055, vec3(2.4)), x / 12.92, lessThanEqual(x, vec3(0.04045)));
}

vec4 shown_at(ivec2 pixel) {
  uvec2 within = uvec2(clamp(pixel, ivec2(0), ivec2(display.size.xy) - 1));
  return unpackUnorm4x8(encoded[within.y * display.size.x + within.x]);
}

void main() {
  vec2 place = gl_FragCoord.xy * display.scale.xy - 0.5;
  ivec2 corner = ivec2(floor(place));
  vec2 share = place - vec2(corner);
  vec4 upper = mix(shown_at(corner), shown_at(corner + ivec2(1, 0)), share.x);
  vec4 lower = mix(shown_at(corner + ivec2(0, 1)), shown_at(corner + ivec2(1, 1)), share.x);
  vec4 shown = mix(upper, lower, share.y);
  color = vec4(DECODES != 0u ? decode_srgb(shown.rgb) : shown.rgb, 1.0);
}
