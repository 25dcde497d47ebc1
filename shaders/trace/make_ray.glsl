// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Creates a ray from an origin and a direction, with all data that traversal needs.

// The tolerance of the box test, relative to the length over which intersections are computed. Every accepted hit lies
// within 8 u S of its primitive (docs/accuracy.md, BK), and the rounding of the box test moves a plane by 6 u S. Vulkan
// allows divisions an error of 2.5 ulp in place of 0.5 ulp, which adds 4 u S to each, and 8 u S to the t of the hit so
// far that limits boxes. A box that is enlarged by 32 u S therefore never hides a hit in any tree.
const float BOX_PADDING = 32.0 * UNIT_ROUNDOFF;
// The tolerance for the rounding of the padded origin; it is twice the largest rounding error. Far from the world's
// origin this error could be as large as the whole padding, and 5 % of the rays at edges and corners at 1e3 and 1e5
// were lost (hard case 28).
const float ORIGIN_PADDING = 2.0 * UNIT_ROUNDOFF;
// The smallest component of a direction in the box test. With this limit nothing overflows in scenes of 10^15, and a
// ray along a box's side still comes no closer to its plane than the padding.
const float SMALLEST_SLOPE = 8.67361737988403547e-19;  // 2^-60

// Returns whether all components are finite. The function tests the bits, because a compiler may assume that there are
// no NaNs.
bool is_finite(vec3 v) {
  uvec3 exponents = floatBitsToUint(v) & 0x7F800000u;
  return all(notEqual(exponents, uvec3(0x7F800000u)));
}

bool is_nan(float x) { return (floatBitsToUint(x) & 0x7FFFFFFFu) > 0x7F800000u; }

vec3 signs_of(vec3 v) { return vec3(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0, v.z < 0.0 ? -1.0 : 1.0); }

// Sets the two origins of the box test from the ray's origin and direction.
void pad_origin(inout Ray ray) {
  vec4 bounds = level_bounds();
  float of_reach = BOX_PADDING;
  if (has(FEATURE_INSTANCES)) of_reach = is_in_instance ? BOX_PADDING : UPPER_PADDING;
  precise float reach = max_abs(ray.origin - bounds.xyz) + bounds.w;
  precise vec3 padding = signs_of(ray.direction) * (of_reach * reach + ORIGIN_PADDING * abs(ray.origin));
  precise vec3 near_origin = ray.origin + padding;
  precise vec3 far_origin = ray.origin - padding;
  ray.near_origin = near_origin;
  ray.far_origin = far_origin;
}

// At a distance of 5e5 radii of the tree, the padding is as large as the tree, so a ray would hit every box. Mirror or
// shadow rays from a large floor may start there. The origin of a ray that starts beyond this number of radii is
// therefore moved nearer to the tree.
const float FAR_AWAY = 1024.0;
// Such a ray must also start beyond this multiple of the tree's own distance from the world's origin. The rounding
// error of the new origin is relative to that distance, which S does not include: rays that were moved from 1e3 radii
// hit a tree at 1e5 with an error of 430 u S (hard case 55). From this distance on the error is a quarter of u S.
const float FAR_FROM_ORIGIN = 8.0;

float distance_to_tree(Ray ray) {
  precise float distance = max_abs(ray.origin - VIEW.tree_bounds.xyz);
  return distance;
}

bool is_far_away(Ray ray) {
  precise float near = max(FAR_AWAY * VIEW.tree_bounds.w, FAR_FROM_ORIGIN * max_abs(VIEW.tree_bounds.xyz));
  return distance_to_tree(ray) > near;
}

// Returns the distance, in units of the ray's t, by which the origin is moved; 0 if it is not moved. The new distance
// is 4 radii plus a thousandth of the old distance. The result has 12 bits, so its product with half of the direction's
// bits is exact.
float shift_to_tree(Ray ray) {
  if (!is_far_away(ray)) return 0.0;
  precise float shift = 0.999 * (distance_to_tree(ray) - 4.0 * VIEW.tree_bounds.w) / max_abs(ray.direction);
  return uintBitsToFloat(floatBitsToUint(shift) & 0xFFFFF000u);
}

// Returns the same ray with the shifted origin; its interval does not change. Close to the tree, where the large
// coordinates of the origin cancel, the new ray deviates from the old one by at most a few u times the remaining
// distance.
Ray moved_along(Ray ray, float shift) {
  vec3 upper = uintBitsToFloat(floatBitsToUint(ray.direction) & 0xFFFFF000u);
  precise vec3 origin = (ray.origin + shift * upper) + shift * (ray.direction - upper);
  ray.origin = origin;
  pad_origin(ray);
  return ray;
}

// Returns the t that a crossing of a moved ray must exceed so that t + shift, rounded to nearest even, exceeds tmin.
// The computation is exact near the tree, where tmin lies between half the shift and twice the shift. A negative result
// counts as 0.
float shifted_tmin(float tmin, float shift) {
  uint bits = floatBitsToUint(tmin);
  precise float half_step = uintBitsToFloat(bits & 0x7F800000u) * UNIT_ROUNDOFF;
  precise float rounds_to_tmin = (tmin - shift) + half_step;
  if (!(rounds_to_tmin > 0.0)) return 0.0;
  // Ties are rounded to the even number.
  return (bits & 1u) == 0u ? rounds_to_tmin : uintBitsToFloat(floatBitsToUint(rounds_to_tmin) - 1u);
}

// Makes a ray. `direction` may have any length from 2^-126 up to below 2^127. `tmin` and `tmax` are in units of the
// direction. Other directions, a NaN, tmin = +infinity and an origin beyond 10^38 give a ray that misses everything.
Ray make_ray(vec3 origin, vec3 direction, float tmin, float tmax) {
  Ray ray;
  float size = max_abs(direction);
  bool is_valid = is_finite(direction) && size >= SMALLEST_NORMAL && size < 1.7014118e+38 && is_finite(origin) &&
                  max_abs(origin) < 1e38 && !is_nan(tmin) && !is_nan(tmax) && tmin < tmax && tmin < INFINITY;
  float scale = is_valid ? power_of_two_inverse(size) : 1.0;
  ray.origin = is_valid ? origin : vec3(0.0);
  ray.direction = is_valid ? direction * scale : vec3(1.0, 0.0, 0.0);
  // The product t * direction does not change: t is multiplied by the factor by which the direction is divided.
  float unscale = power_of_two_inverse(scale);
  // -0 counts as 0 too, because traversal compares the bits of distances that are not negative.
  precise float scaled_tmin = (tmin > 0.0 ? tmin : 0.0) * unscale;
  precise float scaled_tmax = tmax * unscale;
  ray.tmin = is_valid ? scaled_tmin : 1.0;
  ray.tmax = is_valid ? scaled_tmax : 0.0;

  precise float inverse_length2 = 1.0 / dot3(ray.direction, ray.direction);
  ray.inverse_length2 = inverse_length2;

  vec3 signs = signs_of(ray.direction);
  precise vec3 inverse_direction = 1.0 / (signs * max(abs(ray.direction), vec3(SMALLEST_SLOPE)));
  ray.inverse_direction = inverse_direction;
  pad_origin(ray);

  ray.shear_axis = 2u;
  ray.shear = vec3(0.0);
  if (has(FEATURE_TRIANGLES)) {
    vec3 a = abs(ray.direction);
    ray.shear_axis = a.x > a.y ? (a.x > a.z ? 0u : 2u) : (a.y > a.z ? 1u : 2u);
    vec3 d = permute_axes(ray.direction, ray.shear_axis);
    precise vec3 shear = vec3(d.x / d.z, d.y / d.z, 1.0 / d.z);
    ray.shear = shear;
  }
  return ray;
}
