// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Secondary rays start a fixed distance off the surface, whatever the scene's size: the thesis' epsilon.

#define lift_off lift_off_by_bound
#include "shaders/secondary.glsl"
#undef lift_off

precise vec3 lift_off(vec3 position, vec3 geometric_normal, float lift) { return position + 1e-4 * geometric_normal; }
