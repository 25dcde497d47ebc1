// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace promin::test {

/// Queries of a SPIR-V module for tests ("Binary Form" in the SPIR-V specification, from section 2.3).
struct SpirvModule {
  explicit SpirvModule(std::span<const uint32_t> words);

  /// Returns byte offsets of the named struct's members, in order, for every variant of the struct that has offsets.
  std::vector<std::vector<uint32_t>> offsets_of(const std::string& struct_name) const;

  /// SpecId of each specialisation constant, by name.
  std::map<std::string, uint32_t> spec_ids;
  /// Float additions, subtractions, products and quotients without NoContraction, each as "opcode in function".
  std::vector<std::string> contractible;
  uint32_t float_operation_count = 0;
  /// Names of the functions, without the parenthesis and the parameters' types that glslang adds.
  std::set<std::string> functions;
  /// Distinct binding numbers of the storage buffer variables.
  std::set<uint32_t> storage_bindings;

 private:
  std::map<uint32_t, std::string> names_;
  std::map<uint32_t, std::map<uint32_t, uint32_t>> offsets_;
};

}  // namespace promin::test
