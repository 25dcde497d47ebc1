// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Mesa's llvmpipe ends all loops of an invocation after 65535 turns of all of them together
// (LP_MAX_TGSI_LOOP_ITERATIONS), in silence: each then turns once. Hosts ask for a retry or refuse.

// Whether that has come. As the last thing that an invocation does.
bool were_loops_cut() {
  uint turns = 0u;
  while (turns < loop_check_turns()) ++turns;
  return turns < loop_check_turns();
}
