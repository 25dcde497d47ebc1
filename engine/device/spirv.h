// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace promin::gpu {

/// A specialisation constant: `id` is a CONSTANT_* of shaders/layout.h.
struct SpecializationConstant {
  uint32_t id = 0;
  uint32_t value = 0;
};

/// Returns whether a SPIR-V module declares a specialisation constant with this SpecId.
bool has_specialization_constant(std::span<const uint32_t> spirv, uint32_t id);

/// Returns the module without code that is unreachable if its specialisation constants have these values: blocks behind
/// branches that depend only on constants, and functions that are called only from such blocks. The result computes the
/// same and keeps its specialisation constants. Drivers remove this code too, but later: lavapipe first puts all
/// functions into one and unrolls their loops, and a scene of one sphere would pay for every other shape. A function is
/// not changed if a loop's first block begins with an OpPhi, which glslang never writes. Throws std::logic_error if the
/// words are not a SPIR-V module.
std::vector<uint32_t> remove_dead_code(std::span<const uint32_t> spirv,
                                       std::span<const SpecializationConstant> constants);

}  // namespace promin::gpu
