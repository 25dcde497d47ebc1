// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// llvmpipe gives each thread one run of workgroups, first across, then down. Therefore each thread has a row of
// workgroups (engine/trace/kernels/group_rows.h), and the rows take the work in turns: all threads take equally long,
// and consecutive work of a thread is close together.

// Returns the number of the piece of work of this group.
uint group_number() { return gl_WorkGroupID.x * gl_NumWorkGroups.y + gl_WorkGroupID.y; }
