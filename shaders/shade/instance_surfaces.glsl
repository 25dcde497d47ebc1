// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Surfaces of hits, which may be in an instance (trace/instances.glsl).

// Returns the surface of a primitive. `part` is that of a hit; in an instance the surface has the object's material.
SurfaceRecord load_surface_of(uint index, uint part) {
  SurfaceRecord surface = load_surface(index);
  if (is_instance_part(part)) {
    uint material = load_instance_look(part).material;
    uint own = surface.corners_material.w;
    if (material != NO_INSTANCE_MATERIAL) surface.corners_material.w = (own & ~SURFACE_MATERIAL_MASK) | material;
  }
  return surface;
}
