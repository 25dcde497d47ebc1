// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A source at infinity.

LightSample sample_directional(LightRecord light, vec3 position) {
  return LightSample(-light.direction.xyz, INFINITY, 1.0);
}
