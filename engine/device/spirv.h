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

/// Whether a SPIR-V module declares a specialisation constant with this SpecId.
bool has_specialization_constant(std::span<const uint32_t> spirv, uint32_t id);

/// The module without what it cannot reach when its specialisation constants have these values: blocks behind branches
/// that hang on constants alone, and functions that are called from such blocks only. It computes the same, and still
/// has its specialisation constants. Drivers find out the same, but later: lavapipe first puts all functions into one
/// and unrolls their loops, and a scene of one sphere would pay for every other shape. Where a loop's first block
/// begins with an OpPhi, which glslang does not write, the function is left whole.
/// Throws std::logic_error if the words are no SPIR-V module.
std::vector<uint32_t> remove_dead_code(std::span<const uint32_t> spirv,
                                       std::span<const SpecializationConstant> constants);

}  // namespace promin::gpu
