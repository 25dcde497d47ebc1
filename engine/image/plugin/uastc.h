// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

/// The RGBA of the 4x4 texels of a UASTC block (Binomial LLC, "UASTC Texture Specification"), in row order,
/// interpolated as linear channels. Throws std::runtime_error if it is not such a block.
std::array<std::array<uint8_t, 4>, 16> decode_uastc(std::span<const unsigned char, 16> block);
