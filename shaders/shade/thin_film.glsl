// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The reflectance of a surface under a thin film (KHR_materials_iridescence, "Thin film reflectance"; Belcour and
// Barla, "A Practical Extension to Microfacet Theory for the Modeling of Varying Iridescence", SIGGRAPH 2017).
// Thicknesses and path differences are in nanometres.

const float LEAST_FILM_COSINE = 0.015625;  // the smallest cosine at which a film is seen
const float SMOOTH_THICKNESS = 0.03;       // in micrometres; a film thinner than this fades out
const float LONGEST_DIFFERENCE = 1e5;      // the largest path difference with visible interference
const float LARGEST_BASE_REFLECTANCE = 0.9999;
const float LEAST_ROUND_TRIP = 1e-5;

precise float fifth_power(float x) {
  precise float x2 = x * x;
  return x2 * x2 * x;
}

// Returns cos(2 pi x) with an error of at most 3 u for 0 <= x < 2^22. The reduction to |x| <= 1/4 is exact; the rest is
// Taylor's series.
float cosine_of_turns(float turns) {
  precise float part = abs(turns - floor(turns + 0.5));
  bool is_far = part > 0.25;
  precise float near = is_far ? 0.5 - part : part;
  precise float x = 6.28318531 * near;
  precise float x2 = x * x;
  precise float series =
      1.0 + x2 * (-0.5 +
                  x2 * (0.0416666667 +
                        x2 * (-0.00138888889 + x2 * (2.48015873e-5 + x2 * (-2.75573192e-7 + x2 * 2.08767570e-9)))));
  return is_far ? -series : series;
}

// Returns the colour, in linear Rec. 709, of waves with this path difference. It is computed from the eye's
// sensitivities x, y and z, which are Gaussians over frequency; x has two. Each wave has its sign.
vec3 color_of_waves(float path_difference, vec3 signs) {
  float difference = min(path_difference, LONGEST_DIFFERENCE);
  precise float square = difference * difference;
  precise float x0 =
      0.846590002 * cosine_of_turns(1.6810e-3 * difference) * power_of_two(-2.46491222e-7 * square);
  precise float x1 =
      0.153868307 * cosine_of_turns(2.2399e-3 * difference) * power_of_two(-2.57905068e-7 * square);
  precise float y = 1.00022189 * cosine_of_turns(1.7953e-3 * difference) * power_of_two(-5.29946445e-7 * square);
  precise float z = 1.00112249 * cosine_of_turns(2.2084e-3 * difference) * power_of_two(-3.76594254e-7 * square);
  precise vec3 xyz = vec3(signs.x * (x0 + x1), signs.y * y, signs.z * z);
  precise vec3 color = vec3(3.2404542 * xyz.x - 1.5371385 * xyz.y - 0.4985314 * xyz.z,
                            -0.9692660 * xyz.x + 1.8760108 * xyz.y + 0.0415560 * xyz.z,
                            0.0556434 * xyz.x - 0.2040259 * xyz.y + 1.0572252 * xyz.z);
  return color;
}

// Returns the reflectance of film and base at an angle with this cosine. `f0` is the reflectance of the base at normal
// incidence in air.
vec3 film_reflectance(vec3 f0, float ior, float thickness, float cosine) {
  precise float t = min(thickness / SMOOTH_THICKNESS, 1.0);
  precise float film_ior = 1.0 + (ior - 1.0) * (t * t * (3.0 - 2.0 * t));
  precise float inside2 = 1.0 - (1.0 - cosine * cosine) / (film_ior * film_ior);
  float inside = sqrt(max(inside2, 0.0));
  precise float slope = (film_ior - 1.0) / (film_ior + 1.0);
  precise float r0 = slope * slope;
  precise float r12 = r0 + (1.0 - r0) * fifth_power(1.0 - cosine);
  precise float t121 = 1.0 - r12;
  precise vec3 root = sqrt(clamp(f0, vec3(0.0), vec3(LARGEST_BASE_REFLECTANCE)));
  precise vec3 base_ior = (1.0 + root) / (1.0 - root);
  precise vec3 step = (base_ior - film_ior) / (base_ior + film_ior);
  precise vec3 r1 = step * step;
  precise vec3 r23 = r1 + (1.0 - r1) * fifth_power(1.0 - inside);
  precise vec3 round_trip = clamp(r12 * r23, vec3(LEAST_ROUND_TRIP), vec3(LARGEST_BASE_REFLECTANCE));
  precise vec3 amplitude = sqrt(round_trip);
  precise vec3 body = t121 * t121 * r23 / (1.0 - round_trip);
  precise vec3 first = (body - t121) * amplitude;
  precise float difference = 2.0 * film_ior * thickness * inside;
  // The phase of a wave shifts by half a wavelength if the wave is reflected inside the film at its surface, and if the
  // base is denser than the film.
  vec3 signs = vec3(base_ior.x < film_ior ? 1.0 : -1.0, base_ior.y < film_ior ? 1.0 : -1.0,
                    base_ior.z < film_ior ? 1.0 : -1.0);
  precise vec3 sum = r12 + body + 2.0 * first * color_of_waves(difference, signs) +
                     2.0 * first * amplitude * color_of_waves(2.0 * difference, vec3(1.0));
  return clamp(sum, vec3(0.0), vec3(1.0));
}

// Returns the reflectance at normal incidence for which Schlick's formula gives the film's reflectance at this cosine.
vec3 reflectance_under_film(ThinFilm film, vec3 f0, float f90, float cosine) {
  float seen = clamp(cosine, LEAST_FILM_COSINE, 1.0);
  vec3 reflected = film_reflectance(f0, film.layer.y, film.layer.z, seen);
  float grazing = fifth_power(1.0 - seen);
  precise vec3 at_normal = (reflected - f90 * grazing) / (1.0 - grazing);
  return clamp(at_normal, vec3(0.0), vec3(1.0));
}
