// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace promin::gpu {

/// A specialisation constant: `id` is a CONSTANT_* of shaders/shared/layout.h.
struct SpecializationConstant {
  uint32_t id = 0;
  uint32_t value = 0;
};

/// Returns whether a SPIR-V module declares a specialisation constant with this SpecId.
bool has_specialization_constant(std::span<const uint32_t> spirv, uint32_t id);

/// Returns the module for these values of its specialization constants, which it no longer has; a constant that is not
/// given keeps its default. Blocks behind branches that depend on constants alone, functions that are called from such
/// blocks only, and constants that nothing uses are left out. The result computes the same. Two sets of constants that
/// differ in what the shader does not read give the same words.
/// Drivers remove dead code too, but later: lavapipe first puts all functions into one and unrolls their loops, and a
/// scene of one sphere would pay for every other shape. A function with a loop whose first block begins with an OpPhi,
/// which glslang does not write, is left whole.
/// Throws std::logic_error if the words are not a SPIR-V module, or if a specialization constant is neither a bool nor
/// an integer of 32 bits.
std::vector<uint32_t> specialize(std::span<const uint32_t> spirv, std::span<const SpecializationConstant> constants);

}  // namespace promin::gpu
