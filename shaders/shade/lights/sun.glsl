// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Directional lights with an angle: discs of uniform radiance at infinity, as the sun is (docs/model.md, "Lights with a
// size").

LightSample sample_sun(LightRecord light) {
  float sine2 = uintBitsToFloat(light.kind.z);
  precise float cosine = sqrt(1.0 - min(sine2, 1.0));
  precise float cap = sine2 / (1.0 + cosine);
  precise float strength = 2.0 / (1.0 + cosine);
  return LightSample(sample_cone(-light.direction.xyz, cap).direction, INFINITY, strength);
}
