// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// llvmpipe gives each thread one run of workgroups, counted across first, then down. So a row of workgroups is one
// thread's part of the work (engine/trace/share_out.h), and shares are dealt out to the parts in turn. All threads then
// take equally long, and what a thread takes next lies near what it took last.

// The number of the share that this workgroup takes.
uint shared_out_group() { return gl_WorkGroupID.x * gl_NumWorkGroups.y + gl_WorkGroupID.y; }
