// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Loads records and words of the film, of the stream and of pixels, that earlier dispatches have written. Lavapipe
// loads them faster as texels. Texels do not show what a lane has written in the same dispatch, so a lane must read a
// record before it writes it.

layout(constant_id = CONSTANT_FETCHES_FILM_TEXELS) const uint FETCHES_FILM_TEXELS = 0u;
layout(set = 0, binding = BINDING_FILM_TEXELS) uniform usamplerBuffer film_texels;

vec4 load_record(uint record) {
  if (FETCHES_FILM_TEXELS == 0u) return uintBitsToFloat(pixels[record]);
  return uintBitsToFloat(texelFetch(film_texels, int(FILM_HEAD_TEXELS + record)));
}

uint load_word(uint word) {
  if (FETCHES_FILM_TEXELS == 0u) return words[word];
  uvec4 record = texelFetch(film_texels, int(FILM_HEAD_TEXELS + (word >> 2)));
  uvec2 half_of_record = (word & 2u) == 0u ? record.xy : record.zw;
  return (word & 1u) == 0u ? half_of_record.x : half_of_record.y;
}

void store_vector(uint record, vec3 v) { pixels[record].xyz = floatBitsToUint(v); }
