// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Rays with nearby origins and similar directions share a bin, and rays of neighbouring bins are roughly similar
// (engine/rays/ray_order.h sorts rays of casts). Results do not depend on the bins.

// Returns the cell of a coordinate. A bin has for each coordinate two bits of the ray's origin, which lies between -1
// and 1 or beyond, and one bit of its direction. More bits are not faster (docs/performance_log.md).
uint cell_of(float x, uint levels) {
  precise float cell = (0.5 * x + 0.5) * float(1u << levels);
  return min(uint(cell > 0.0 ? min(cell, 64.0) : 0.0), (1u << levels) - 1u);
}

uvec3 cells_of(vec3 v, uint levels) {
  return uvec3(cell_of(v.x, levels), cell_of(v.y, levels), cell_of(v.z, levels));
}

uint bits_of(uvec3 cells) { return cells.z << 2 | cells.y << 1 | cells.x; }

uint bin_of(vec3 origin, vec3 direction) {
  precise vec3 place = (origin - VIEW.tree_bounds.xyz) / VIEW.tree_bounds.w;
  uvec3 cells = cells_of(place, 2u);
  uvec3 octant = cells_of(direction, 1u);
  uint bin = bits_of(octant) << 6 | bits_of(cells >> 1) << 3 | bits_of(cells & 1u);
  return min(bin, BIN_WITHOUT_RAY - 1u);
}
