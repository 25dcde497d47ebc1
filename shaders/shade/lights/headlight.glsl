// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A source at infinity behind the camera, whichever way the camera looks.

LightSample sample_headlight(LightRecord light, vec3 position) {
  return LightSample(-CAMERA.look.xyz, INFINITY, 1.0);
}
