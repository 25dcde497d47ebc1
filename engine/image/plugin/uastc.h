// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

/// Returns the RGBA of the 4x4 texels of a UASTC block (Binomial LLC, "UASTC Texture Specification"), in row order,
/// interpolated as linear channels. Throws std::runtime_error if the bytes are not such a block.
std::array<std::array<uint8_t, 4>, 16> decode_uastc(std::span<const unsigned char, 16> block);
