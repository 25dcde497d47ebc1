// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Writes the lists of a turn of the stream from the requests of the previous turn.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "shared/layout.h"

layout(local_size_x = BLOCK_SIZE * BLOCK_SIZE) in;

#include "shared/bindings.glsl"
#include "picture/film.glsl"
#include "picture/stream.glsl"
#include "picture/stream_records.glsl"
#include "shared/group_rows.glsl"

uint place_of(uint kind, uint ask) {
  return load_word(places_of_bins(kind) + (ask & (STREAM_BINS - 1u))) + (ask >> STREAM_BIN_BITS);
}

void main() {
  begin_stream();
  uint last_turn = turn - 1u;
  uint place = group_number() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  // Clears the bins of the next turn.
  uint lanes = gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_WorkGroupSize.x;
  for (uint i = place; i < STREAM_LISTS * STREAM_BINS; i += lanes) words[counts_of_bins(LIST_OF_PATHS) + i] = 0u;
  if (place >= paths_of_turn(last_turn)) return;
  uint path = load_word(path_list(last_turn) + place);
  uint asked = load_word(ask_of_path(path));
  if (asked == ASK_NOTHING) return;
  words[path_list(turn) + place_of(LIST_OF_PATHS, asked)] = path;
  if (turn == 0u) return;
  for (uint source = 0u; source < sources_of_turn; ++source) {
    uint asked_of_source = load_word(ask_of_source(path, source));
    if (asked_of_source == ASK_NOTHING) continue;
    words[shadow_list() + place_of(LIST_OF_SHADOW_RAYS, asked_of_source)] = path * STREAM_SOURCES + source;
  }
}
