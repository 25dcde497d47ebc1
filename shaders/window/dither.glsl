// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Noise for 8-bit values, the same as in engine/image/dither.h for files.

uint mix_bits(uint x) {
  x ^= x >> 16;
  x *= 0x7FEB352Du;
  x ^= x >> 15;
  x *= 0x846CA68Bu;
  return x ^ x >> 16;
}

float dithered(float code, uvec2 pixel, uint channel) {
  uint first = mix_bits(pixel.x + mix_bits(pixel.y + mix_bits(channel)));
  uint second = mix_bits(first);
  bool is_at_end = code < 1.0 || code > 254.0;
  uint sum = (first >> 9) + (is_at_end ? 1u << 22 : second >> 9);
  return clamp(code + (float(sum) * (1.0 / 8388608.0) - 1.0), 0.0, 255.0);
}
