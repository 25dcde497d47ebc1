// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Secondary rays start some floats off the surface, or a fixed distance near the world's origin: Wächter and Binder, "A
// Fast and Robust Method for Avoiding Self-Intersection", Ray Tracing Gems, chapter 6, with its constants.

#define lift_off lift_off_by_bound
#include "shaders/secondary.glsl"
#undef lift_off

float step_floats(float x, float along) {
  int steps = int(256.0 * along);
  float moved = intBitsToFloat(floatBitsToInt(x) + (x < 0.0 ? -steps : steps));
  precise float near = x + along / 65536.0;
  return abs(x) < 1.0 / 32.0 ? near : moved;
}

vec3 lift_off(vec3 position, vec3 geometric_normal, float lift) {
  // `precise`, or glslang 12 fails.
  precise vec3 origin = vec3(step_floats(position.x, geometric_normal.x), step_floats(position.y, geometric_normal.y),
                             step_floats(position.z, geometric_normal.z));
  return origin;
}
