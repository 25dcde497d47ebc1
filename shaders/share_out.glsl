// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// CPU drivers give each thread as many workgroups in a row. So that these take as long, groups in a row take their work
// from as many parts of all.

// Which share of the work this group takes. The number of groups is a multiple of that of parts.
uint shared_out_group() {
  uint parts = dispatch.share.x;
  return gl_WorkGroupID.x % parts * (gl_NumWorkGroups.x / parts) + gl_WorkGroupID.x / parts;
}
