// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The sheen of cloth (KHR_materials_sheen; docs/model.md, "Metallic-roughness"): fibres that stand on the surface, and
// are visible if they are seen or lit from the side.

const float LEAST_SHEEN_ROUGHNESS = 0.07;
const float LOG2_E = 1.44269504;

float sheen_alpha(float roughness) {
  precise float alpha = max(roughness, LEAST_SHEEN_ROUGHNESS) * max(roughness, LEAST_SHEEN_ROUGHNESS);
  return alpha;
}

// Returns the logarithm of Lambda for inclinations below 60 degrees to the horizon. It is a curve that Estevez and
// Kulla fitted ("Production Friendly Microfacet Sheen BRDF", SIGGRAPH 2017 course notes, section 3).
float fitted_lambda(float x, float alpha) {
  precise float t = (1.0 - alpha) * (1.0 - alpha);
  precise float a = 21.5473 + t * (25.3245 - 21.5473);
  precise float b = 3.82987 + t * (3.32435 - 3.82987);
  precise float c = 0.19823 + t * (0.16801 - 0.19823);
  precise float d = -1.97760 + t * (-1.27393 + 1.97760);
  precise float e = -4.32054 + t * (-4.85967 + 4.32054);
  precise float fitted = a / (1.0 + b * power(x, c)) + d * x + e;
  return fitted;
}

// Returns the ratio of hidden to visible fibres at an angle with this cosine.
float sheen_lambda(float cosine, float alpha) {
  precise float from_normal = 1.0 - cosine;
  precise float logarithm = cosine < 0.5 ? fitted_lambda(cosine, alpha)
                                         : 2.0 * fitted_lambda(0.5, alpha) - fitted_lambda(from_normal, alpha);
  precise float exponent = LOG2_E * logarithm;
  return power_of_two(exponent);
}

// Returns the radiance that a sheen of colour 1 sends to the eye if a source causes an irradiance of 1 perpendicular to
// its direction. h is the half vector. The sine of its angle is computed from |h - normal|, which keeps the digits that
// 1 - (N.H)^2 loses.
float sheen_of_source(vec3 normal, float roughness, vec3 h, vec3 to_eye, float cosine) {
  float alpha = sheen_alpha(roughness);
  float v = max(dot3(normal, to_eye), LEAST_COSINE);
  precise vec3 apart = h - normal;
  precise float q = dot3(apart, apart);
  precise float s2 = min(q * (1.0 - 0.25 * q), 1.0);
  precise float inverse_alpha = 1.0 / alpha;
  precise float exponent = 0.5 * inverse_alpha;
  precise float density = (2.0 + inverse_alpha) * power(s2, exponent) * (0.5 * INVERSE_PI);
  precise float visibility =
      min(1.0 / ((1.0 + sheen_lambda(v, alpha) + sheen_lambda(cosine, alpha)) * (4.0 * v * cosine)), 1.0);
  precise float sent = density * visibility * cosine;
  return sent;
}
