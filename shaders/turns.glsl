// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The turns of the stream: a bounce takes one, or where the scene has more sources than a turn takes several.

uint turns_of_bounce() {
  return sources_of_turn == 0u ? 1u : (source_count() + sources_of_turn - 1u) / sources_of_turn;
}
bool begins_bounce(uint which) { return which % turns_of_bounce() == 0u; }
// The first of the sources that a turn takes, and how many it takes.
uint first_source(uint which) { return (which % turns_of_bounce()) * sources_of_turn; }
uint sources_at(uint which) { return min(sources_of_turn, source_count() - first_source(which)); }
// How many entries of the log come after that of a source of the last turn, and it (ray_log.glsl).
uint entry_of_source(uint source) {
  return sources_at(turn - 1u) - source + (begins_bounce(turn) ? 1u : 0u);
}
