// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Starts a turn of the stream, in one workgroup: computes where each bin begins in the list, and the number of
// workgroups for the remainder of the turn. Each lane sums all bins before its own, because lanes share no memory.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "shared/layout.h"

layout(local_size_x = STREAM_LANES) in;

#include "shared/bindings.glsl"
#include "picture/film.glsl"
#include "picture/stream.glsl"
#include "picture/stream_records.glsl"

// Returns the number of workgroups for this number of lanes, arranged in rows (engine/trace/kernels/group_rows.h).
uvec4 groups_of(uint lanes) {
  uint groups = (lanes + BLOCK_SIZE * BLOCK_SIZE - 1u) / (BLOCK_SIZE * BLOCK_SIZE);
  uint rows = min(groups, stream.place.w);
  return rows == 0u ? uvec4(0u, 1u, 1u, 0u) : uvec4((groups + rows - 1u) / rows, rows, 1u, 0u);
}

void end_list(uint kind, uint before_last_bin, uint size) {
  if (kind == LIST_OF_SHADOW_RAYS) {
    stream.shadow_rays.x = size;
    stream.shadow_groups = groups_of(size);
    return;
  }
  uint this_turn = turn + 1u;
  stream.list_groups = groups_of(paths_of_turn(turn));
  stream.turn.w = before_last_bin;
  if ((this_turn & 1u) == 0u) {
    stream.turn.y = size;
  } else {
    stream.turn.z = size;
  }
  stream.turn.x = this_turn;
  stream.path_groups = groups_of(size);
}

void main() {
  begin_stream();
  const uint run = STREAM_BINS / STREAM_LANES;
  uint lane = gl_LocalInvocationIndex;
  for (uint kind = 0u; kind < STREAM_LISTS; ++kind) {
    uint counts = counts_of_bins(kind);
    uvec4 sums = uvec4(0u);
    for (uint bin = 0u; bin < run * lane; bin += 4u) sums += floatBitsToUint(load_record((counts + bin) / 4u));
    uint place = sums.x + sums.y + sums.z + sums.w;
    uint before_last_bin = 0u;
    for (uint bin = run * lane; bin < run * (lane + 1u); ++bin) {
      words[places_of_bins(kind) + bin] = place;
      before_last_bin = place;
      place += load_word(counts + bin);
    }
    if (lane == STREAM_LANES - 1u) end_list(kind, before_last_bin, place);
  }
}
