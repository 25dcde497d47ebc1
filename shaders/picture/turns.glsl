// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The turns of the stream: a bounce takes one, or several if the scene has more light sources than a turn can take.

uint turns_of_bounce() {
  return sources_of_turn == 0u ? 1u : (source_count() + sources_of_turn - 1u) / sources_of_turn;
}
bool begins_bounce(uint which) { return which % turns_of_bounce() == 0u; }
// first_source() returns the first light source of a turn; the next function returns their number.
uint first_source(uint which) { return (which % turns_of_bounce()) * sources_of_turn; }
uint sources_at(uint which) { return min(sources_of_turn, source_count() - first_source(which)); }
// Returns the position of the log entry of a light source of the last turn, counted from the end (ray_log.glsl).
uint entry_of_source(uint source) {
  return sources_at(turn - 1u) - source + (begins_bounce(turn) ? 1u : 0u);
}
