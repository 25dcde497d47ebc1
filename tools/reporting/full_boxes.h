// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>

#include "device_scene/pack_scene.h"
#include "promin/math.h"

namespace promin::report {

/// Children of a node with their boxes as they are: two of layout.h's nodes, as tools/plain/full_boxes reads them.
using FullNode = std::array<layout::Node, 2>;

/// `children` are words of layout::Node::children, as many as boxes, at most NODE_WIDTH.
FullNode pack_full_node(std::span<const Bounds> boxes, const uvec4& children);

/// The same tree with full boxes, for kernels made with tools/plain/full_boxes: 128 bytes a node instead of 64. Of a
/// tree whose builder splits no primitive.
PackedScene with_full_boxes(PackedScene packed);

}  // namespace promin::report
