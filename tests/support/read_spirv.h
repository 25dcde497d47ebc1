// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <vector>

#include "core/file.h"

namespace promin {

/// Returns the words of a SPIR-V file. Throws InputError if it cannot be read.
inline std::vector<uint32_t> read_spirv(const std::filesystem::path& file) {
  const std::vector<std::byte> bytes = read_file(file);
  std::vector<uint32_t> words(bytes.size() / sizeof(uint32_t));
  std::memcpy(words.data(), bytes.data(), words.size() * sizeof(uint32_t));
  return words;
}

}  // namespace promin
