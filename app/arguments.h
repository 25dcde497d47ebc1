// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "promin/math.h"

namespace CLI {
class App;
}

namespace promin::app {

/// The words that the user gave to one option. Every reading throws UsageError, which names the option, what it takes
/// and what it got.
class OptionValues {
 public:
  /// `placeholders` are those of OptionTable::add.
  OptionValues(std::string command, std::string option, std::string placeholders, std::vector<std::string> words)
      : command_(std::move(command)),
        option_(std::move(option)),
        placeholders_(std::move(placeholders)),
        words_(std::move(words)) {}

  const std::vector<std::string>& all() const { return words_; }
  const std::string& text() const { return words_.front(); }
  /// Reads a decimal number in min...max.
  uint32_t whole(size_t i, uint32_t min, uint32_t max) const;
  /// Reads a number in min...max, both included. `others` are words that the option takes as well, which the caller has
  /// looked for.
  double real(size_t i, double min, double max, std::span<const std::string_view> others = {}) const;
  /// Reads the only word as a quotient, as "1/64"; nullopt where it has no line. The caller checks the range.
  std::optional<double> fraction() const;
  /// Reads three numbers in -max...max.
  dvec3 vector(double max) const;
  /// Reads one of `choices`.
  const std::string& choice(std::span<const std::string_view> choices) const;

  /// Splits the only word into parts, each to be read as a word of the same option. What refuses a part tells the
  /// whole.
  OptionValues with(std::vector<std::string> parts) const {
    OptionValues values(command_, option_, placeholders_, std::move(parts));
    values.whole_word_ = text();
    return values;
  }

  /// `near` is a word that the user may have meant.
  [[noreturn]] void refuse(const std::string& what, std::string_view near = {}) const;

 private:
  void refuse_option(size_t i) const;
  /// As messages quote it.
  std::string quote(size_t i) const;

  std::string command_;
  std::string option_;
  std::string placeholders_;
  std::vector<std::string> words_;
  /// What the words are parts of, where they are.
  std::string whole_word_;
};

/// The options of a command, one row each. The last of a repeated option holds.
class OptionTable {
 public:
  explicit OptionTable(CLI::App& command);

  using Setter = std::function<void(const OptionValues&)>;
  /// `names` as "-s,--spp", or "SCENE" for what has no dash; `placeholders` has a word for each word that the option
  /// takes: "N", "W H". "R G B|word|other" is three words, or one of the others alone, which the setter gets three
  /// times; in capitals such a word stands for any that is no number.
  void add(const std::string& names, const std::string& placeholders, const std::string& help, Setter set);
  /// Adds an argument that the command cannot do without.
  void add_required(const std::string& names, const std::string& placeholders, const std::string& help, Setter set);
  /// An option of one word that may be given several times; the setter gets all.
  void add_repeated(const std::string& names, const std::string& placeholder, const std::string& help, Setter set);
  /// The same, which the command cannot do without; for an argument without a dash too.
  void add_required_repeated(const std::string& names, const std::string& placeholder, const std::string& help,
                             Setter set);
  /// An option that help and suggestions do not name, as `set` refuses it. It takes one word.
  void add_hidden(const std::string& name, Setter set);
  void add_flag(const std::string& names, const std::string& help, bool& value);

 private:
  CLI::App& command_;
};

/// A command of the program: its options are rows in `app`, its work is `run`.
struct Command {
  CLI::App* app = nullptr;
  std::function<void()> run;
};

/// Whether a word is a decimal number and nothing else.
bool is_number(const std::string& word);

/// The parts of a text between commas.
std::vector<std::string> split_list(const std::string& list);

/// All commands that a program has.
std::vector<const CLI::App*> commands_of(const CLI::App& program);

/// The options and arguments that a parsed command was given, by the names that messages have, in the order of its
/// table; with the words that give them again: of what is repeated those that hold, one where one stands for several,
/// of a flag none.
std::vector<std::pair<std::string, std::vector<std::string>>> given_options(const CLI::App& command);

/// Adds a command with --help and --version.
CLI::App& add_command(CLI::App& program, const std::string& name, const std::string& help);

/// Adds the options that every command has, the program itself too.
void add_common_options(CLI::App& app);

/// Reads the command line. False if it asked for help or the version, which are then printed. Throws UsageError.
bool parse_arguments(CLI::App& program, int argc, const char* const* argv);

}  // namespace promin::app
