// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// CPU drivers give each thread as many workgroups in a row. So that all take as long, the work is dealt out to as many
// parts as there are threads; the groups of a part, which are in a row, take shares that lie near each other.

// Which share of the work this group takes.
uint shared_out_group() { return gl_WorkGroupID.x * gl_NumWorkGroups.y + gl_WorkGroupID.y; }
