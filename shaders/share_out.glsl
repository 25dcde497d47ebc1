// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// CPU drivers give each thread as many workgroups in a row. So that all take as long, the work is dealt out to as many
// parts as there are threads, and groups in a row take a part's shares one after the other, which lie near each other.

// Which share of the work this group takes. The number of groups is a multiple of that of parts.
uint shared_out_group() {
  uint parts = dispatch.share.x;
  uint part_groups = gl_NumWorkGroups.x / parts;
  return gl_WorkGroupID.x % part_groups * parts + gl_WorkGroupID.x / part_groups;
}
