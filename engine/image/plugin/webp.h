// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

// OpenImageIO multiplies the colours of WebP by their alpha, whatever it is asked for, and so loses those under alpha 0
// (OpenImageIO#3917): libwebp itself keeps them apart.

/// Width and height of a WebP file. Throws std::runtime_error where it is none, or moves.
std::pair<uint32_t, uint32_t> read_webp_size(std::span<const unsigned char> file);

/// Its pixels, as RGBA. Throws std::runtime_error where they are damaged.
void read_webp(std::span<const unsigned char> file, std::span<unsigned char> pixels);
