// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Mesa's llvmpipe ends all loops of an invocation after 65535 turns of all of them together
// (LP_MAX_TGSI_LOOP_ITERATIONS), without an error. From then on each loop turns once. Hosts trace again or refuse
// (docs/glossary.md, cut loops).

// Whether loops were cut. Call it as the last thing that an invocation does.
bool were_loops_cut() {
  uint turns = 0u;
  while (turns < loop_check_turns()) ++turns;
  return turns < loop_check_turns();
}
