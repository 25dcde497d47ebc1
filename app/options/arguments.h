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

/// The words that the user gave to one option. All functions throw UsageError, which names the option, its values and
/// the given words.
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
  /// Reads a number in min...max, both included. `others` are words that the option also takes, for the message; the
  /// caller has tested for them.
  double real(size_t i, double min, double max, std::span<const std::string_view> others = {}) const;
  /// Reads the only word as a quotient such as "1/64"; nullopt if it has no slash. The caller checks the range.
  std::optional<double> fraction() const;
  /// Reads three numbers in -max...max.
  dvec3 vector(double max) const;
  /// Reads one of `choices`.
  const std::string& choice(std::span<const std::string_view> choices) const;

  /// Returns parts of the only word, each to be read as a word of the same option. Messages about a part also quote the
  /// whole word.
  OptionValues with(std::vector<std::string> parts) const {
    OptionValues values(command_, option_, placeholders_, std::move(parts));
    values.whole_word_ = text();
    return values;
  }

  /// `near` is a word that the user may have meant.
  [[noreturn]] void refuse(const std::string& what, std::string_view near = {}) const;

 private:
  void refuse_option(size_t i) const;
  /// Returns the word as messages quote it.
  std::string quote(size_t i) const;

  std::string command_;
  std::string option_;
  std::string placeholders_;
  std::vector<std::string> words_;
  /// The whole word, if the words are parts of it.
  std::string whole_word_;
};

/// The options of a command, one row each. If an option is repeated, the last one counts.
class OptionTable {
 public:
  explicit OptionTable(CLI::App& command);

  using Setter = std::function<void(const OptionValues&)>;
  /// Adds an option. `names` is like "-s,--spp", or "SCENE" for an argument without a dash; `placeholders` has a word
  /// for each value of the option: "N", "W H". "R G B|word|other" stands for three words, or for one of the other
  /// words, which the setter receives three times; a word in capitals stands for any word that is not a number.
  void add(const std::string& names, const std::string& placeholders, const std::string& help, Setter set);
  /// Adds a required argument.
  void add_required(const std::string& names, const std::string& placeholders, const std::string& help, Setter set);
  /// Adds an option of one word that may be repeated; the setter receives all.
  void add_repeated(const std::string& names, const std::string& placeholder, const std::string& help, Setter set);
  /// Adds a required one of this kind, also for an argument without a dash.
  void add_required_repeated(const std::string& names, const std::string& placeholder, const std::string& help,
                             Setter set);
  /// Adds an option of one word that help and suggestions do not name, because `set` refuses it.
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

/// Returns whether the whole word is a decimal number.
bool is_number(const std::string& word);

/// Returns the parts of a text between commas.
std::vector<std::string> split_list(const std::string& list);

/// Returns all commands of a program.
std::vector<const CLI::App*> commands_of(const CLI::App& program);

/// Returns the options and arguments of a parsed command, by their names in messages and in the order of its table,
/// with the words that give them again: for a repeated option those that count, one word if one stands for several,
/// none for a flag.
std::vector<std::pair<std::string, std::vector<std::string>>> given_options(const CLI::App& command);

/// Adds a command with --help and --version.
CLI::App& add_command(CLI::App& program, const std::string& name, const std::string& help);

/// Adds the options that every command and the program itself have.
void add_common_options(CLI::App& app);

/// Reads the command line. Returns false if it requests help or the version, which are then printed. Throws UsageError.
bool parse_arguments(CLI::App& program, int argc, const char* const* argv);

}  // namespace promin::app
