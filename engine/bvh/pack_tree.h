// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "bvh/builder.h"
#include "core/unset_vector.h"
#include "shared/layout.h"

namespace promin {

/// A binary tree in the device's form: nodes with up to four children. The children's boxes are stored in bytes and
/// contain the boxes of the binary tree. `stack_size` is the largest number of entries on the stack of a traversal.
struct PackedTree {
  UnsetVector<layout::Node> nodes;
  uint32_t stack_size = 1;
};
PackedTree pack_tree(const Bvh& bvh);

}  // namespace promin
