// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Pixels, sample points and primary rays.

// Returns a lane's pixel in the block. Lanes are in Morton order, so that neighbours in a subgroup of any size are
// neighbours in the picture.
uvec2 pixel_in_block(uint lane) {
  uint x = (lane & 1u) | ((lane >> 1) & 2u) | ((lane >> 2) & 4u);
  uint y = ((lane >> 1) & 1u) | ((lane >> 2) & 2u) | ((lane >> 3) & 4u);
  return uvec2(x, y);
}

// Returns the ray through a place in a pixel and the chosen point of the lens (choose_sample). All rays of a place meet
// in the plane in focus. t has the same unit as without a lens.
Ray lens_ray(uvec2 pixel, vec2 place) {
  precise vec2 from_center = (vec2(pixel) - CAMERA.film_center.xy) + place;
  precise vec3 on_film = from_center.x * CAMERA.right.xyz - from_center.y * CAMERA.up.xyz;
  vec3 disc = point_on_disc(sample_pair_point());
  precise vec3 offset = CAMERA.film_center.z * (disc.x * CAMERA.right.xyz + disc.y * CAMERA.up.xyz);
  precise vec3 turned = CAMERA.look.xyz - CAMERA.film_center.w * offset;
  if (!is_orthographic()) {
    precise vec3 direction = turned + on_film;
    precise vec3 origin = CAMERA.eye.xyz + offset;
    return make_ray(origin, direction, CAMERA.eye.w, INFINITY);
  }
  precise vec3 origin = (CAMERA.eye.xyz + on_film) + offset;
  return make_ray(origin, turned, CAMERA.eye.w, INFINITY);
}

// Returns the ray through a place in a pixel. Its direction is D = V - O, where V lies on the viewport at distance 1
// along `look`. Therefore t is in units of the viewport's distance, and points beyond the near plane have t > near. D
// is not normalised.
Ray ray_through(uvec2 pixel, vec2 place) {
  if (has(FEATURE_LENS)) return lens_ray(pixel, place);
  precise vec2 from_center = (vec2(pixel) - CAMERA.film_center.xy) + place;
  precise vec3 on_film = from_center.x * CAMERA.right.xyz - from_center.y * CAMERA.up.xyz;
  if (!is_orthographic()) {
    precise vec3 direction = CAMERA.look.xyz + on_film;
    return make_ray(CAMERA.eye.xyz, direction, CAMERA.eye.w, INFINITY);
  }
  precise vec3 origin = CAMERA.eye.xyz + on_film;
  return make_ray(origin, CAMERA.look.xyz, CAMERA.eye.w, INFINITY);
}

Ray camera_ray(uvec2 window_pixel) { return ray_through(window_corner() + window_pixel, sample_point()); }

// Returns the ray for a record of the film that the host has written, with FEATURE_LISTED_SAMPLES
// (engine/trace/film/film.h).
Ray listed_ray(uint record) {
  uvec4 listed = pixels[record];
  return ray_through(uvec2(listed.z & 0xFFFFu, listed.z >> 16), uintBitsToFloat(listed.xy));
}
