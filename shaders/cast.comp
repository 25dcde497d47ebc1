// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Casts rays: finds the nearest hit or, with ALL_ASK_FOR_ANY, whether there is any hit.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "layout.h"
#include "bindings.glsl"
#include "cast_bindings.glsl"
#include "math.glsl"
#include "ray.glsl"
#include "make_ray.glsl"
#include "primitives.glsl"
#include "packet.glsl"
#include "no_cutouts.glsl"
#include "packet_shapes.glsl"
#include "packet_triangles.glsl"
#include "family.glsl"
#include "node_boxes.glsl"
#include "traversal.glsl"
#include "group_rows.glsl"
#include "loop_check.glsl"
#include "cast.glsl"
