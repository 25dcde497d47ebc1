// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/spirv.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <ranges>
#include <stdexcept>

#define SPV_ENABLE_UTILITY_CODE
#include <spirv/unified1/spirv.hpp11>

namespace promin::gpu {
namespace {

using spv::Op;

constexpr size_t kHeaderWords = 5;
constexpr size_t kIdBoundWord = 3;

/// The words of one instruction. The first word has the opcode and the length.
using Words = std::span<const uint32_t>;

Op op_of(Words instruction) {
  return static_cast<Op>(instruction[0] & spv::OpCodeMask);
}

uint32_t word(Op op, uint32_t length) {
  return static_cast<uint32_t>(op) | length << spv::WordCountShift;
}

/// Calls `visit` with each instruction until it returns false.
void visit_instructions(std::span<const uint32_t> spirv, const std::function<bool(Words)>& visit) {
  for (size_t i = kHeaderWords; i < spirv.size();) {
    const size_t length = spirv[i] >> spv::WordCountShift;
    if (length == 0 || length > spirv.size() - i) throw std::logic_error("these words are not a SPIR-V module");
    if (!visit(spirv.subspan(i, length))) return;
    i += length;
  }
}

/// Returns the id of the instruction's result, if it has one.
std::optional<uint32_t> result_of(Words instruction) {
  bool has_result = false;
  bool has_type = false;
  spv::HasResultAndType(op_of(instruction), &has_result, &has_type);
  if (!has_result) return std::nullopt;
  return instruction[has_type ? 2 : 1];
}

/// The instructions of a block, from its OpLabel to its terminator.
struct Block {
  std::vector<Words> instructions;
  bool is_live = true;

  uint32_t label() const { return instructions.front()[1]; }
  Words terminator() const { return instructions.back(); }
  /// Returns the instruction before the terminator if it has this opcode: OpLoopMerge in the first block of a loop, or
  /// OpSelectionMerge. Otherwise returns an empty span.
  Words merge(Op kind) const {
    if (instructions.size() < 2) return {};
    const Words before = instructions[instructions.size() - 2];
    return op_of(before) == kind ? before : Words();
  }
};

struct Function {
  /// OpFunction and the function's parameters.
  std::vector<Words> head;
  std::vector<Block> blocks;
  bool is_live = false;

  uint32_t id() const { return head.front()[2]; }
};

/// The known values of ids that are bools (0 and 1) or 32-bit integers.
class KnownValues {
 public:
  KnownValues(uint32_t id_bound, std::span<const SpecializationConstant> constants)
      : constants_(constants.begin(), constants.end()),
        values_(id_bound),
        spec_ids_(id_bound),
        is_scalar_(id_bound),
        is_bool_(id_bound) {}

  std::optional<uint32_t> of(uint32_t id) const { return values_.at(id); }
  bool is_bool(uint32_t type) const { return is_bool_.at(type); }

  /// Records the value of a constant, for an instruction before the first function.
  void learn_constant(Words instruction) {
    switch (op_of(instruction)) {
      case Op::OpDecorate:
        if (instruction[2] == static_cast<uint32_t>(spv::Decoration::SpecId))
          spec_ids_.at(instruction[1]) = instruction[3];
        break;
      case Op::OpTypeBool:
        is_scalar_.at(instruction[1]) = true;
        is_bool_.at(instruction[1]) = true;
        break;
      case Op::OpTypeInt:
        is_scalar_.at(instruction[1]) = instruction[2] == 32;
        break;
      case Op::OpConstantTrue:
      case Op::OpSpecConstantTrue:
        learn(instruction, 1);
        break;
      case Op::OpConstantFalse:
      case Op::OpSpecConstantFalse:
        learn(instruction, 0);
        break;
      case Op::OpConstant:
      case Op::OpSpecConstant:
        learn(instruction, instruction[3]);
        break;
      case Op::OpSpecConstantOp:
        learn(instruction, evaluate(static_cast<Op>(instruction[3]), instruction.subspan(4)));
        break;
      default:
        break;
    }
  }

  /// Records the value of a result, for an instruction in a function other than OpPhi.
  void learn_result(Words instruction) {
    if (instruction.size() > 3 && result_of(instruction)) {
      learn(instruction, evaluate(op_of(instruction), instruction.subspan(3)));
    }
  }

  void learn(Words instruction, std::optional<uint32_t> value) {
    const uint32_t id = instruction[2];
    const bool is_scalar = is_scalar_.at(instruction[1]);
    if (const auto spec_id = spec_ids_.at(id)) {
      const auto has_id = [&](const SpecializationConstant& constant) { return constant.id == *spec_id; };
      const auto chosen = std::ranges::find_if(constants_, has_id);
      if (chosen != constants_.end()) value = chosen->value;
      if (!is_scalar) throw std::logic_error("a specialization constant is neither a bool nor an integer of 32 bits");
    }
    if (is_scalar) values_.at(id) = value;
  }

 private:
  /// Returns the value of an operation if conditions use such operations and its operands are known.
  std::optional<uint32_t> evaluate(Op op, Words operands) const {
    const auto operand = [&](size_t i) {
      return i < operands.size() && operands[i] < values_.size() ? values_[operands[i]] : std::nullopt;
    };
    if (op == Op::OpSelect) {
      const auto condition = operand(0);
      return condition ? operand(*condition != 0 ? 1 : 2) : std::nullopt;
    }
    const auto a = operand(0);
    const auto b = operand(1);
    if (op == Op::OpLogicalNot && a) return *a ^ 1U;
    if (op == Op::OpLogicalAnd && (a == 0U || b == 0U)) return 0;
    if (op == Op::OpLogicalOr && (a == 1U || b == 1U)) return 1;
    if (!a || !b) return std::nullopt;
    switch (op) {
      case Op::OpLogicalAnd:
      case Op::OpBitwiseAnd:
        return *a & *b;
      case Op::OpLogicalOr:
      case Op::OpBitwiseOr:
        return *a | *b;
      case Op::OpIAdd:
        return *a + *b;
      case Op::OpISub:
        return *a - *b;
      case Op::OpIMul:
        return *a * *b;
      // A shift by more than 31 is undefined.
      case Op::OpShiftRightLogical:
        return *b < 32 ? std::optional(*a >> *b) : std::nullopt;
      case Op::OpShiftLeftLogical:
        return *b < 32 ? std::optional(*a << *b) : std::nullopt;
      case Op::OpIEqual:
      case Op::OpLogicalEqual:
        return *a == *b;
      case Op::OpINotEqual:
      case Op::OpLogicalNotEqual:
        return *a != *b;
      case Op::OpULessThan:
        return *a < *b;
      case Op::OpULessThanEqual:
        return *a <= *b;
      case Op::OpUGreaterThan:
        return *a > *b;
      case Op::OpUGreaterThanEqual:
        return *a >= *b;
      default:
        return std::nullopt;
    }
  }

  std::vector<SpecializationConstant> constants_;
  std::vector<std::optional<uint32_t>> values_;
  std::vector<std::optional<uint32_t>> spec_ids_;
  /// For each id of a type, whether the type is a bool or a 32-bit integer.
  std::vector<bool> is_scalar_;
  std::vector<bool> is_bool_;
};

struct Module {
  explicit Module(std::span<const uint32_t> spirv) {
    visit_instructions(spirv, [&](Words instruction) {
      add(instruction);
      return true;
    });
  }

  /// The instructions before the first function.
  std::vector<Words> head;
  std::vector<Function> functions;

 private:
  void add(Words instruction) {
    const Op op = op_of(instruction);
    if (op == Op::OpFunction) functions.emplace_back();
    if (functions.empty()) {
      head.push_back(instruction);
    } else if (op == Op::OpFunction || op == Op::OpFunctionParameter) {
      functions.back().head.push_back(instruction);
    } else if (op != Op::OpFunctionEnd) {
      if (op == Op::OpLabel) functions.back().blocks.emplace_back();
      if (functions.back().blocks.empty()) throw std::logic_error("a SPIR-V function begins without a label");
      functions.back().blocks.back().instructions.push_back(instruction);
    }
  }
};

/// Finds the unreachable code of a function, and writes the reachable code.
class FunctionPruner {
 public:
  FunctionPruner(Function& function, KnownValues& values) : function_(function), values_(values) {
    for (Block& block : function_.blocks) {
      block_of_.emplace_back(block.label(), &block);
    }
    std::ranges::sort(block_of_);
    // In each round fewer blocks can be reached, so more values are known, and then fewer blocks are live. No round
    // marks live code as dead.
    size_t before = function_.blocks.size();
    for (size_t now = mark_live_blocks(); now != before; now = mark_live_blocks()) before = now;
  }

  std::vector<uint32_t> called_functions() const {
    std::vector<uint32_t> called;
    for (const Block& block : function_.blocks) {
      for (const Words instruction : block.instructions) {
        if (block.is_live && op_of(instruction) == Op::OpFunctionCall) called.push_back(instruction[3]);
      }
    }
    return called;
  }

  void write(std::vector<uint32_t>& out) const {
    for (const Words instruction : function_.head) append(out, instruction);
    for (const Block& block : function_.blocks) {
      if (block.is_live) {
        write_live(block, out);
      } else {
        write_dead(block, out);
      }
    }
    out.push_back(word(Op::OpFunctionEnd, 1));
  }

 private:
  static void append(std::vector<uint32_t>& out, Words words) { out.insert(out.end(), words.begin(), words.end()); }

  Block& block_of(uint32_t label) const {
    const auto found = std::ranges::lower_bound(block_of_, label, {}, &std::pair<uint32_t, Block*>::first);
    if (found == block_of_.end() || found->first != label) throw std::logic_error("a SPIR-V branch leads nowhere");
    return *found->second;
  }

  /// Returns the only block to which a conditional branch can lead, if it is known. A branch from the end of a loop to
  /// its beginning stays, because SPIR-V requires one in each loop.
  std::optional<uint32_t> known_target(const Block& block) const {
    const Words terminator = block.terminator();
    if (op_of(terminator) != Op::OpBranchConditional) return std::nullopt;
    const auto condition = values_.of(terminator[1]);
    if (!condition) return std::nullopt;
    const uint32_t other = terminator[*condition != 0 ? 3 : 2];
    if (&block_of(other) <= &block) return std::nullopt;
    return terminator[*condition != 0 ? 2 : 3];
  }

  std::vector<uint32_t> successors(const Block& block) const {
    const Words terminator = block.terminator();
    if (const auto target = known_target(block)) return {*target};
    switch (op_of(terminator)) {
      case Op::OpBranch:
        return {terminator[1]};
      case Op::OpBranchConditional:
        return {terminator[2], terminator[3]};
      case Op::OpSwitch: {
        std::vector<uint32_t> targets = {terminator[2]};
        // The operands are pairs of a 32-bit literal and a label.
        for (size_t i = 4; i < terminator.size(); i += 2) targets.push_back(terminator[i]);
        return targets;
      }
      default:
        return {};
    }
  }

  bool leads_to(const Block& from, uint32_t label) const {
    return from.is_live && std::ranges::count(successors(from), label) > 0;
  }

  /// Returns the value of an OpPhi if all values with which the block may be entered are known and equal.
  std::optional<uint32_t> phi_value(Words phi, uint32_t label) const {
    std::optional<uint32_t> common;
    for (size_t i = 3; i + 1 < phi.size(); i += 2) {
      if (!leads_to(block_of(phi[i + 1]), label)) continue;
      const auto value = values_.of(phi[i]);
      if (!value || (common && *common != *value)) return std::nullopt;
      common = value;
    }
    return common;
  }

  /// Blocks come before the blocks that they dominate, so a value is found before its use. Only OpPhi may use a later
  /// value.
  size_t mark_live_blocks() {
    for (const Block& block : function_.blocks) {
      for (const Words instruction : block.instructions) {
        if (op_of(instruction) == Op::OpPhi) {
          values_.learn(instruction, phi_value(instruction, block.label()));
        } else {
          values_.learn_result(instruction);
        }
      }
    }
    for (Block& block : function_.blocks) block.is_live = false;
    std::vector<Block*> open = {&function_.blocks.front()};
    size_t count = 0;
    while (!open.empty()) {
      Block& block = *open.back();
      open.pop_back();
      if (block.is_live) continue;
      block.is_live = true;
      ++count;
      for (const uint32_t label : successors(block)) open.push_back(&block_of(label));
    }
    return count;
  }

  void write_live(const Block& block, std::vector<uint32_t>& out) const {
    const auto target = known_target(block);
    for (const Words instruction : block.instructions) {
      switch (op_of(instruction)) {
        case Op::OpPhi:
          write_phi(instruction, block, out);
          break;
        case Op::OpSelectionMerge:
          if (!target) append(out, instruction);
          break;
        case Op::OpBranchConditional:
          if (target) {
            out.insert(out.end(), {word(Op::OpBranch, 2), *target});
          } else {
            append(out, instruction);
          }
          break;
        default:
          append(out, instruction);
      }
    }
  }

  void write_phi(Words phi, const Block& block, std::vector<uint32_t>& out) const {
    const size_t first = out.size();
    out.insert(out.end(), phi.begin(), phi.begin() + 3);
    for (size_t i = 3; i + 1 < phi.size(); i += 2) {
      if (leads_to(block_of(phi[i + 1]), block.label())) append(out, phi.subspan(i, 2));
    }
    // A dead continue target leads back to its loop (write_dead). Nothing reaches it, so any value will do.
    const Words loop = block.merge(Op::OpLoopMerge);
    if (!loop.empty() && !block_of(loop[2]).is_live) out.insert(out.end(), {phi[2], loop[2]});
    out[first] = word(Op::OpPhi, static_cast<uint32_t>(out.size() - first));
  }

  /// Writes a block that is never executed. It must stay if a live block names it as the end of its selection or loop,
  /// or as its continue target.
  void write_dead(const Block& block, std::vector<uint32_t>& out) const {
    bool is_merge = false;
    std::optional<uint32_t> loop;
    for (const Block& other : function_.blocks) {
      if (!other.is_live) continue;
      const Words loop_merge = other.merge(Op::OpLoopMerge);
      const Words selection_merge = known_target(other) ? Words() : other.merge(Op::OpSelectionMerge);
      for (const Words merge : {loop_merge, selection_merge}) {
        is_merge = is_merge || (!merge.empty() && merge[1] == block.label());
      }
      if (!loop_merge.empty() && loop_merge[2] == block.label()) loop = other.label();
    }
    if (!is_merge && !loop) return;
    append(out, block.instructions.front());
    if (loop) {
      out.insert(out.end(), {word(Op::OpBranch, 2), *loop});
    } else {
      out.push_back(word(Op::OpUnreachable, 1));
    }
  }

  Function& function_;
  KnownValues& values_;
  /// The blocks, sorted by label.
  std::vector<std::pair<uint32_t, Block*>> block_of_;
};

/// Marks functions that the entry points reach, and returns their remaining code.
std::vector<uint32_t> prune_functions(Module& module, KnownValues& values) {
  std::vector<uint32_t> open;
  for (const Words instruction : module.head) {
    if (op_of(instruction) == Op::OpEntryPoint) open.push_back(instruction[2]);
  }
  std::vector<std::pair<const Function*, std::vector<uint32_t>>> written;
  while (!open.empty()) {
    const uint32_t id = open.back();
    open.pop_back();
    const auto found = std::ranges::find(module.functions, id, &Function::id);
    if (found == module.functions.end()) throw std::logic_error("a SPIR-V module calls a function that it lacks");
    if (found->is_live) continue;
    found->is_live = true;
    const FunctionPruner pruner(*found, values);
    for (const uint32_t called : pruner.called_functions()) open.push_back(called);
    pruner.write(written.emplace_back(&*found, std::vector<uint32_t>()).second);
  }
  // Sorts the functions in their original order.
  std::ranges::sort(written, {}, [](const auto& entry) { return entry.first; });
  std::vector<uint32_t> words;
  for (const auto& [function, left] : written) words.insert(words.end(), left.begin(), left.end());
  return words;
}

bool is_constant(Op op) {
  switch (op) {
    case Op::OpConstantTrue:
    case Op::OpConstantFalse:
    case Op::OpConstant:
    case Op::OpConstantComposite:
    case Op::OpConstantNull:
    case Op::OpSpecConstantTrue:
    case Op::OpSpecConstantFalse:
    case Op::OpSpecConstant:
    case Op::OpSpecConstantComposite:
    case Op::OpSpecConstantOp:
      return true;
    default:
      return false;
  }
}

/// Returns the operands of an instruction with a result that can be ids. For instructions that this function does not
/// know, some of these operands are literals.
Words operands_of(Words instruction) {
  size_t first = 3;
  size_t count = instruction.size();
  switch (op_of(instruction)) {
    case Op::OpConstantTrue:
    case Op::OpConstantFalse:
    case Op::OpConstant:
    case Op::OpConstantNull:
      count = 0;
      break;
    case Op::OpLoad:
    case Op::OpCompositeExtract:
      count = 1;
      break;
    case Op::OpCompositeInsert:
    case Op::OpVectorShuffle:
      count = 2;
      break;
    case Op::OpVariable:
    case Op::OpSpecConstantOp:
      first = 4;
      break;
    case Op::OpExtInst:
      first = 5;
      break;
    default:
      break;
  }
  first = std::min(first, instruction.size());
  return instruction.subspan(first, std::min(count, instruction.size() - first));
}

/// Marks the ids that an instruction reads. Some literals are taken for ids.
void mark_used(Words instruction, std::vector<bool>& is_used) {
  const Words operands = result_of(instruction) ? operands_of(instruction) : instruction.subspan(1);
  for (const uint32_t operand : operands) {
    if (operand < is_used.size()) is_used[operand] = true;
  }
}

/// Returns whether an instruction defines a variable that only functions of this module can use.
bool is_own_variable(Words instruction) {
  if (op_of(instruction) != Op::OpVariable) return false;
  const auto storage = static_cast<spv::StorageClass>(instruction[3]);
  return storage == spv::StorageClass::Function || storage == spv::StorageClass::Private;
}

/// Returns the functions without the variables that no instruction uses: those of inlined functions whose blocks are
/// never reached.
std::vector<uint32_t> without_unused_variables(Words functions, uint32_t id_bound) {
  std::vector<bool> is_used(id_bound);
  const auto visit = [&](const auto& visitor) {
    for (size_t i = 0; i < functions.size(); i += functions[i] >> spv::WordCountShift) {
      visitor(functions.subspan(i, functions[i] >> spv::WordCountShift));
    }
  };
  visit([&](Words instruction) { mark_used(instruction, is_used); });
  std::vector<uint32_t> written;
  written.reserve(functions.size());
  visit([&](Words instruction) {
    if (is_own_variable(instruction) && !is_used.at(instruction[2])) return;
    written.insert(written.end(), instruction.begin(), instruction.end());
  });
  return written;
}

/// Writes the instructions before the functions. Constants have their known values, and unused definitions are left
/// out.
class HeadWriter {
 public:
  HeadWriter(const Module& module, const KnownValues& values, Words functions, uint32_t id_bound)
      : head_(module.head), values_(values), is_defined_(id_bound), is_used_(id_bound) {
    for (size_t i = 0; i < functions.size(); i += functions[i] >> spv::WordCountShift) {
      const Words instruction = functions.subspan(i, functions[i] >> spv::WordCountShift);
      if (const auto id = result_of(instruction)) is_defined_.at(*id) = true;
      use(instruction);
    }
    for (const Words instruction : head_) {
      if (const auto id = result_of(instruction)) is_defined_.at(*id) = true;
      // Only constants are composed of other constants here: the other operands are literals, types and variables.
      const Op op = op_of(instruction);
      if (is_own_variable(instruction) && !is_used_.at(instruction[2])) {
        is_defined_.at(instruction[2]) = false;
      } else if (op == Op::OpTypeArray || op == Op::OpVariable || op == Op::OpExecutionModeId) {
        use(instruction);
      }
    }
    // A constant comes after its components, so the loop runs backwards.
    for (const Words instruction : std::views::reverse(head_)) {
      if (!is_constant(op_of(instruction))) continue;
      const uint32_t id = instruction[2];
      if (!is_used_.at(id)) is_defined_.at(id) = false;
      if (is_used_.at(id) && !values_.of(id)) use(instruction);
    }
  }

  void write(std::vector<uint32_t>& out) const {
    for (const Words instruction : head_) {
      const Op op = op_of(instruction);
      if (is_about_id(instruction) && !is_defined_.at(instruction[1])) continue;
      if (op == Op::OpDecorate && instruction[2] == static_cast<uint32_t>(spv::Decoration::SpecId)) continue;
      if (is_own_variable(instruction) && !is_defined_.at(instruction[2])) continue;
      if (!is_constant(op)) {
        out.insert(out.end(), instruction.begin(), instruction.end());
      } else if (is_defined_.at(instruction[2])) {
        write_constant(instruction, out);
      }
    }
  }

 private:
  static bool is_about_id(Words instruction) {
    return op_of(instruction) == Op::OpName || op_of(instruction) == Op::OpDecorate;
  }

  void use(Words instruction) { mark_used(instruction, is_used_); }

  void write_constant(Words instruction, std::vector<uint32_t>& out) const {
    const auto value = values_.of(instruction[2]);
    if (!value) {
      out.insert(out.end(), instruction.begin(), instruction.end());
    } else if (values_.is_bool(instruction[1])) {
      out.insert(out.end(),
                 {word(*value != 0 ? Op::OpConstantTrue : Op::OpConstantFalse, 3), instruction[1], instruction[2]});
    } else {
      out.insert(out.end(), {word(Op::OpConstant, 4), instruction[1], instruction[2], *value});
    }
  }

  const std::vector<Words>& head_;
  const KnownValues& values_;
  /// For each id, whether the written module defines it. Names and decorations do not count.
  std::vector<bool> is_defined_;
  std::vector<bool> is_used_;
};

}  // namespace

bool has_specialization_constant(std::span<const uint32_t> spirv, uint32_t id) {
  bool is_found = false;
  visit_instructions(spirv, [&](Words instruction) {
    is_found = op_of(instruction) == Op::OpDecorate &&
               instruction[2] == static_cast<uint32_t>(spv::Decoration::SpecId) && instruction[3] == id;
    return !is_found;
  });
  return is_found;
}

std::vector<uint32_t> specialize(std::span<const uint32_t> spirv, std::span<const SpecializationConstant> constants) {
  if (spirv.size() < kHeaderWords) throw std::logic_error("these words are no SPIR-V module");
  Module module(spirv);
  const uint32_t id_bound = spirv[kIdBoundWord];
  KnownValues values(id_bound, constants);
  for (const Words instruction : module.head) values.learn_constant(instruction);
  const std::vector<uint32_t> functions = without_unused_variables(prune_functions(module, values), id_bound);
  std::vector<uint32_t> written(spirv.begin(), spirv.begin() + kHeaderWords);
  HeadWriter(module, values, functions, id_bound).write(written);
  written.insert(written.end(), functions.begin(), functions.end());
  return written;
}

}  // namespace promin::gpu
