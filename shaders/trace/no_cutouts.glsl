// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// For kernels whose rays see only geometry and ignore materials (cutouts.glsl).

bool is_cut_out(vec3 direction, Primitive p, uint index, Crossing crossing, bool is_on_open_edge) { return false; }
bool may_have_holes(uint index) { return false; }
bool is_catcher(uint index) { return false; }
