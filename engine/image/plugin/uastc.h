// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

/// The RGBA of the 4x4 texels of a UASTC block (Binomial LLC, "UASTC Texture Specification"), row after row, as linear
/// channels are interpolated. Throws std::runtime_error where it is no such block.
std::array<std::array<uint8_t, 4>, 16> decode_uastc(std::span<const unsigned char, 16> block);
