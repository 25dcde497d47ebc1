// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// llvmpipe gives each thread one run of workgroups, across first, then down. So there is a row of them for each thread
// (engine/trace/group_rows.h), and the rows take the work in turn: all threads take as long, and what a thread takes
// next lies near what it took last.

// Which piece of the work this group takes.
uint group_number() { return gl_WorkGroupID.x * gl_NumWorkGroups.y + gl_WorkGroupID.y; }
