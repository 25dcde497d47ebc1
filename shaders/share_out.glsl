// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// llvmpipe gives each thread one run of workgroups, across first, then down. So a row of them is a part of the work for a
// thread (engine/trace/share_out.h), and shares are dealt out to the parts in turn: all threads take as long, and what
// a thread takes next lies near what it took last.

// Which share of the work this group takes.
uint shared_out_group() { return gl_WorkGroupID.x * gl_NumWorkGroups.y + gl_WorkGroupID.y; }
