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

/// Returns the module with these values in place of its specialization constants. A constant without a given value
/// keeps its default. The function removes blocks that branches on constants never reach, functions that are called
/// only from such blocks, and constants and variables that nothing uses. The result computes the same as the module.
/// Two sets of constants that differ only in constants that the shader does not read give the same words. Drivers
/// remove dead code too, but later: lavapipe first inlines all functions and unrolls their loops, so a scene of one
/// sphere would pay for every other shape. Throws std::logic_error if the words are not a SPIR-V module, or if a
/// specialization constant is neither a bool nor an integer of 32 bits.
std::vector<uint32_t> specialize(std::span<const uint32_t> spirv, std::span<const SpecializationConstant> constants);

}  // namespace promin::gpu
