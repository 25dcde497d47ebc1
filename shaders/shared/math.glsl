// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Arithmetic in an order that drivers must not change: `precise` forbids contraction and reassociation. GLSL's dot(),
// cross(), length() and normalize() leave the order to the driver, so promin has its own versions.

const float UNIT_ROUNDOFF = 5.9604644775390625e-8;  // 2^-24
const float SMALLEST_NORMAL = 1.17549435e-38;      // 2^-126
const float LARGEST_FLOAT = 3.40282347e+38;
const float TWO_POW_MINUS_80 = 8.271806125530277e-25;
#define INFINITY uintBitsToFloat(0x7F800000u)

precise float dot3(vec3 a, vec3 b) { return a.x * b.x + (a.y * b.y + a.z * b.z); }

precise vec3 cross3(vec3 a, vec3 b) {
  return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

precise float length3(vec3 v) { return sqrt(dot3(v, v)); }

float max_abs(vec3 v) { return max(abs(v.x), max(abs(v.y), abs(v.z))); }

// Returns 2^-e for x in [2^e, 2^(e+1)), so that multiplying by it is exact. x must be normal and below 2^127.
float power_of_two_inverse(float x) { return uintBitsToFloat((254u << 23) - (floatBitsToUint(x) & 0x7F800000u)); }

// Returns v / |v| for any v for which |v|^2 neither overflows nor underflows, with a relative error <= 3 u. A zero
// vector stays zero.
precise vec3 normalize3(vec3 v) {
  float size = max_abs(v);
  if (!(size > 0.0)) return vec3(0.0);
  precise vec3 scaled = v * power_of_two_inverse(size);
  return scaled * (1.0 / length3(scaled));
}

// Returns 2^z for z < 128, accurate to a few u; 0 in place of subnormal results. It uses a Taylor series for |f| <=
// 0.5.
precise float power_of_two(float z) {
  if (!(z > -126.0)) return 0.0;
  precise float n = floor(z + 0.5);
  precise float f = z - n;
  precise float e =
      1.0 + f * (0.693147181 +
                 f * (0.240226507 +
                      f * (0.0555041087 + f * (0.00961812911 + f * (0.00133335581 + f * 0.000154035304)))));
  return e * uintBitsToFloat(uint(int(n) + 127) << 23);
}

// Returns x^y for x in (0, 1] and y >= 0. GLSL's pow is exp2(y * log2(x)), where log2 may have an absolute error of
// 2^-21, which is 0.3 % of a highlight with exponent 10^4. Here the relative error of the logarithm is a few u, so the
// result is accurate to a few u * |y log2 x|. The logarithm is computed with the series of atanh, |s| <= 0.172.
precise float power(float x, float y) {
  uint bits = floatBitsToUint(x);
  int exponent = int(bits >> 23) - 127;
  precise float m = uintBitsToFloat((bits & 0x007FFFFFu) | 0x3F800000u);
  if (m > 1.41421356) {
    m = 0.5 * m;
    exponent += 1;
  }
  precise float s = (m - 1.0) / (m + 1.0);
  precise float s2 = s * s;
  precise float series =
      s * (2.88539008 + s2 * (0.961796694 + s2 * (0.577078016 + s2 * (0.412198583 + s2 * 0.320598898))));
  precise float z = y * (float(exponent) + series);
  return power_of_two(z);
}

// Return the sine and the cosine of an angle of at most pi / 4, accurate to a few u. GLSL's own functions may have an
// absolute error of 2^-11.
precise float short_sine(float x) {
  precise float x2 = x * x;
  return x + x * x2 * (-0.166666667 + x2 * (0.00833333333 + x2 * (-0.000198412698 + x2 * 2.75573192e-6)));
}
precise float short_cosine(float x) {
  precise float x2 = x * x;
  return 1.0 + x2 * (-0.5 + x2 * (0.0416666667 + x2 * (-0.00138888889 + x2 * 2.48015873e-5)));
}

// Returns -x if `other` is negative, else x.
float times_sign_of(float x, float other) {
  return uintBitsToFloat(floatBitsToUint(x) ^ (floatBitsToUint(other) & 0x80000000u));
}

// greater() and lesser() return the second number if either is a NaN. NaNs result from 0 * infinity in scenes beyond
// 10^18. The interval is then bounded by tmin or by the hit so far. GLSL's max and min take three instructions each on
// lavapipe; these functions take one.
vec4 greater(vec4 a, vec4 b) {
  precise vec4 result =
      vec4(a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z, a.w > b.w ? a.w : b.w);
  return result;
}
vec4 lesser(vec4 a, vec4 b) {
  precise vec4 result =
      vec4(a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z, a.w < b.w ? a.w : b.w);
  return result;
}
float lesser(float a, float b) { return a < b ? a : b; }
