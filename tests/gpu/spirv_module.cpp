// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "gpu/spirv_module.h"

#include <cstring>

namespace promin::test {
namespace {

enum Opcode : uint32_t {
  kName = 5,
  kFunction = 54,
  kVariable = 59,
  kDecorate = 71,
  kMemberDecorate = 72,
  kFAdd = 129,
  kFSub = 131,
  kFMul = 133,
  kFDiv = 136,
  kFRem = 140,
  kFMod = 141,
  kVectorTimesScalar = 142,
  kDot = 148,
};
constexpr uint32_t kSpecId = 1;
constexpr uint32_t kBinding = 33;
constexpr uint32_t kOffset = 35;
constexpr uint32_t kNoContraction = 42;
constexpr uint32_t kStorageBufferClass = 12;

std::string literal_string(const uint32_t* words) {
  return reinterpret_cast<const char*>(words);
}

bool is_float_operation(uint32_t opcode) {
  switch (opcode) {
    case kFAdd:
    case kFSub:
    case kFMul:
    case kFDiv:
    case kFRem:
    case kFMod:
    case kVectorTimesScalar:
    case kDot:
      return true;
    default:
      return false;
  }
}

}  // namespace

SpirvModule::SpirvModule(std::span<const uint32_t> words) {
  std::set<uint32_t> uncontracted;
  std::map<uint32_t, uint32_t> spec_id_of;
  std::map<uint32_t, uint32_t> binding_of;
  std::string function;
  constexpr size_t kHeaderWords = 5;
  for (size_t i = kHeaderWords; i < words.size();) {
    const uint32_t* op = &words[i];
    const uint32_t opcode = op[0] & 0xFFFFU;
    if (opcode == kName) names_[op[1]] = literal_string(op + 2);
    if (opcode == kFunction) {
      function = names_[op[2]];
      functions.insert(function.substr(0, function.find('(')));
    }
    if (opcode == kDecorate && op[2] == kNoContraction) uncontracted.insert(op[1]);
    if (opcode == kDecorate && op[2] == kSpecId) spec_id_of[op[1]] = op[3];
    if (opcode == kDecorate && op[2] == kBinding) binding_of[op[1]] = op[3];
    if (opcode == kMemberDecorate && op[3] == kOffset) offsets_[op[1]][op[2]] = op[4];
    if (opcode == kVariable && op[3] == kStorageBufferClass) storage_bindings.insert(binding_of.at(op[2]));
    if (is_float_operation(opcode)) {
      ++float_operation_count;
      if (!uncontracted.contains(op[2])) contractible.push_back(std::to_string(opcode) + " in " + function);
    }
    i += op[0] >> 16;
  }
  for (const auto& [id, spec_id] : spec_id_of) spec_ids[names_[id]] = spec_id;
}

std::vector<std::vector<uint32_t>> SpirvModule::offsets_of(const std::string& struct_name) const {
  std::vector<std::vector<uint32_t>> found;
  for (const auto& [id, members] : offsets_) {
    if (names_.at(id) != struct_name) continue;
    std::vector<uint32_t>& offsets = found.emplace_back();
    for (const auto& [member, offset] : members) offsets.push_back(offset);
  }
  return found;
}

}  // namespace promin::test
