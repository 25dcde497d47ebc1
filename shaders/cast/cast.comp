// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Casts rays: finds the nearest hit or, with ALL_ASK_FOR_ANY, whether there is any hit.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/layout.h"
#include "shared/bindings.glsl"
#include "cast/cast_bindings.glsl"
#include "shared/math.glsl"
#include "trace/ray.glsl"
#include "trace/make_ray.glsl"
#include "trace/primitives.glsl"
#include "trace/packet.glsl"
#include "trace/no_cutouts.glsl"
#include "trace/packet_shapes.glsl"
#include "trace/packet_triangles.glsl"
#include "trace/family.glsl"
#include "trace/node_boxes.glsl"
#include "trace/traversal.glsl"
#include "shared/group_rows.glsl"
#include "shared/loop_check.glsl"
#include "cast/cast.glsl"
