// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Shows an encoded film (encode_film.comp) in a window of any size. Each pixel of the window shows the nearest one of
// the film.
#version 450

// 1 for surfaces that take linear values and encode them themselves.
layout(constant_id = 0) const uint DECODES = 0u;

layout(std430, set = 0, binding = 0) readonly buffer Encoded { uint encoded[]; };

layout(push_constant) uniform Display {
  uvec4 size;  // x, y = the film's in pixels
  vec4 scale;  // x, y = pixels of the film for one of the window
} display;

layout(location = 0) out vec4 color;

vec3 decode_srgb(vec3 x) {
  return mix(pow((x + 0.055) / 1.055, vec3(2.4)), x / 12.92, lessThanEqual(x, vec3(0.04045)));
}

void main() {
  uvec2 pixel = min(uvec2(gl_FragCoord.xy * display.scale.xy), display.size.xy - 1u);
  vec4 shown = unpackUnorm4x8(encoded[pixel.y * display.size.x + pixel.x]);
  color = vec4(DECODES != 0u ? decode_srgb(shown.rgb) : shown.rgb, 1.0);
}
