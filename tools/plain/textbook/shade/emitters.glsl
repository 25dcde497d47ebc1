// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Scenes for the textbook's methods have no surfaces that light others.

struct Emitter {
  uint index;
  uint part;
  float area;
  float chance;
};

Emitter choose_emitter(LightRecord light, uvec2 bits, out vec2 u) {
  u = vec2(0.0);
  return Emitter(0u, EMITTER_IS_LIGHT, 0.0, 1.0);
}

LightSample sample_emitter(Emitter emitter, vec2 u, vec3 position, vec3 facing, inout LightRecord light) {
  return LightSample(vec3(0.0), 0.0, 0.0);
}

LightSample sample_rectangle_source(LightRecord light, uvec2 bits, vec3 position) {
  return LightSample(vec3(0.0), 0.0, 0.0);
}
