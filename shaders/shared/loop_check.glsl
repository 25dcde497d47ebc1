// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Mesa's llvmpipe ends all loops of an invocation after 65535 iterations of all loops together
// (LP_MAX_TGSI_LOOP_ITERATIONS), without an error. From then on each loop runs once. The host traces again or refuses
// (docs/glossary.md, cut loops).

// Returns whether loops were cut. Call it at the end of an invocation.
bool were_loops_cut() {
  uint most = loop_check_turns();
  uint turns = 0u;
  while (turns < most) ++turns;
  return turns < most;
}
