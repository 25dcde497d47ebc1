// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Names for the words of `dispatch` (layout.h, Dispatch). Include this file after declaring the buffer that contains
// it.

// For pictures: the dispatch traces one sample of each pixel of the blocks [first, end).
uint first_block() { return dispatch.range.x; }
uint end_block() { return dispatch.range.y; }
uint sample_at_hand() { return dispatch.range.z; }
uint most_bounces() { return dispatch.range.w; }
// For casts: the dispatch traces the rays [first, end).
uint first_ray() { return dispatch.range.x; }
uint end_ray() { return dispatch.range.y; }

// The corner and the size of the window in pixels.
uvec2 window_corner() { return dispatch.window.xy; }
uvec2 window_size() { return dispatch.window.zw; }
uint window_pixel_count() { return dispatch.window.z * dispatch.window.w; }

uint most_tree_rays() { return dispatch.outcome.y; }
float least_tree_weight() { return uintBitsToFloat(dispatch.outcome.z); }

uint samples_per_pixel() { return dispatch.sampling.x; }
// Returns the sample's position in pixels from the upper left corner of each pixel (engine/device_scene/sampling.h).
vec2 sample_point() { return uintBitsToFloat(uvec2(dispatch.sampling.y, dispatch.outcome.w)); }
uint blocks_per_row() { return dispatch.sampling.z; }
bool is_orthographic() { return dispatch.sampling.w != 0u; }

uint first_unbounded() { return dispatch.counts.x; }
uint end_unbounded() { return dispatch.counts.x + dispatch.counts.y; }
uint light_count() { return dispatch.counts.z; }
uint loop_check_turns() { return dispatch.counts.w; }
