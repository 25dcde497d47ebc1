// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Shows a film in a window of any size: the nearest pixel's sum over samples, divided and encoded as PNGs are.
#version 450

// Encodes to sRGB, where the surface does not.
layout(constant_id = 0) const uint ENCODES = 1u;

layout(std430, set = 0, binding = 0) readonly buffer Film { uvec4 records[]; };

layout(push_constant) uniform Display {
  uvec4 film;   // x, y = its size in pixels, z = index of the first pixel's record
  vec4 scale;   // x, y = pixels of the film for one of the window, z = samples a pixel
} display;

layout(location = 0) out vec4 color;

vec3 encode_srgb(vec3 linear) {
  vec3 x = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}

void main() {
  uvec2 pixel = min(uvec2(gl_FragCoord.xy * display.scale.xy), display.film.xy - 1u);
  uvec4 record = records[display.film.z + pixel.y * display.film.x + pixel.x];
  vec3 radiance = uintBitsToFloat(record.xyz) / display.scale.z;
  color = vec4(ENCODES != 0u ? encode_srgb(radiance) : radiance, 1.0);
}
