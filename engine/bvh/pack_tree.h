// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "bvh/builder.h"
#include "core/unset_vector.h"
#include "shared/layout.h"

namespace promin {

/// The device's form of a binary tree: nodes of up to four children, whose boxes in bytes contain those of the binary
/// tree; and the largest number of entries on the stack of a traversal.
struct PackedTree {
  UnsetVector<layout::Node> nodes;
  uint32_t stack_size = 1;
};
PackedTree pack_tree(const Bvh& bvh);

}  // namespace promin
