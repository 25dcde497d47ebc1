// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// This is make_ray.glsl without the parts that make it robust: boxes keep their exact size.

// The textbook's rays are never moved: they start at their own origin.
bool is_far_away(Ray ray) { return false; }
float distance_to_tree(Ray ray) { return 0.0; }
float shift_to_tree(Ray ray) {
  // The variable here, and others below, are needed because versions 12 and 15 of glslang crash on some results without
  // one.
  float shift = 0.0;
  return shift;
}
Ray moved_along(Ray ray, float shift) { return ray; }
float shifted_tmin(float tmin, float shift) {
  float shifted = tmin;
  return shifted;
}

Ray make_ray(vec3 origin, vec3 direction, float tmin, float tmax) {
  Ray ray;
  // The scale is not for robustness. The interface needs it, because cast.glsl returns t in these units.
  float scale = power_of_two_inverse(max_abs(direction));
  ray.origin = origin;
  ray.direction = direction * scale;
  ray.tmin = max(tmin, 0.0) / scale;
  ray.tmax = tmax / scale;
  ray.inverse_length2 = 1.0 / dot(ray.direction, ray.direction);
  // This is not 1 / 0, because a quantised box would multiply it: 0 * infinity.
  vec3 signs = mix(vec3(1.0), vec3(-1.0), lessThan(ray.direction, vec3(0.0)));
  ray.inverse_direction = 1.0 / (signs * max(abs(ray.direction), vec3(1e-18)));
  ray.near_origin = origin;
  ray.far_origin = origin;
  ray.shear_axis = 0u;
  ray.shear = vec3(0.0);
  return ray;
}
