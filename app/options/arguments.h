// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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
#include "work/spec/value_words.h"

namespace CLI {
class App;
}

namespace promin::app {

/// The words that the user gave to one option. All functions throw UsageError. The error names the option, its values
/// and the given words.
class OptionValues {
 public:
  /// `placeholders` has the form of the argument of OptionTable::add().
  OptionValues(std::string command, std::string option, std::string placeholders, std::vector<std::string> words)
      : command_(std::move(command)),
        option_(std::move(option)),
        placeholders_(std::move(placeholders)),
        words_(std::move(words)) {}

  const std::vector<std::string>& all() const { return words_; }
  const std::string& text() const { return words_.front(); }
  /// Reads a decimal number in min...max.
  uint32_t whole(size_t i, uint32_t min, uint32_t max) const;
  /// Reads a number in min...max, both included. `others` are words that the option also accepts, for the message; the
  /// caller has already tested for them.
  double real(size_t i, double min, double max, std::span<const std::string_view> others = {}) const;
  /// Reads the only word as a quotient such as "1/64"; nullopt if it has no slash. The caller checks the range.
  std::optional<double> fraction() const;
  /// Reads three numbers in -max...max.
  dvec3 vector(double max) const;
  /// Reads one of `choices`.
  const std::string& choice(std::span<const std::string_view> choices) const;

  /// Reads a name of an enumeration, whose values are the indices of `names`. The first `hidden` names are not for
  /// users.
  template <typename Enum>
  Enum name(std::span<const std::string_view> names, size_t hidden = 0) const {
    const auto found = std::ranges::find(names, choice(names.subspan(hidden)));
    return static_cast<Enum>(found - names.begin());
  }

  /// Reads the only word by a function that throws WrongValue.
  template <typename Read>
  auto read(const Read& read_word) const {
    try {
      return read_word(text());
    } catch (const work::WrongValue& wrong) {
      refuse_option(0);
      refuse(std::string(option_).append(" ").append(wrong.what), wrong.near);
    }
  }

  /// Returns parts of the only word as words of the same option, so that each can be read. Messages about a part also
  /// quote the whole word.
  OptionValues with(std::vector<std::string> parts) const {
    OptionValues values(command_, option_, placeholders_, std::move(parts));
    values.whole_word_ = text();
    return values;
  }

  /// Throws UsageError. `near` is a word that the user may have meant.
  [[noreturn]] void refuse(const std::string& what, std::string_view near = {}) const;

 private:
  void refuse_option(size_t i) const;
  /// Returns a word in quotes, for messages.
  std::string quote(size_t i) const;

  std::string command_;
  std::string option_;
  std::string placeholders_;
  std::vector<std::string> words_;
  /// The whole word, if the words are its parts.
  std::string whole_word_;
};

/// The options of a command, one row each. If an option is repeated, the last one counts.
class OptionTable {
 public:
  explicit OptionTable(CLI::App& command);

  using Setter = std::function<void(const OptionValues&)>;
  /// Adds an option. `names` is like "-s,--spp", or "SCENE" for an argument without a dash; `placeholders` has a word
  /// for each value of the option: "N", "W H". "R G B|word|other" stands for three words, or for one of the words after
  /// a bar, which the setter receives three times. A word in capitals stands for any word that is not a number.
  void add(const std::string& names, const std::string& placeholders, const std::string& help, Setter set);
  /// Adds a required argument.
  void add_required(const std::string& names, const std::string& placeholders, const std::string& help, Setter set);
  /// Adds an option with one word that may be repeated. The setter receives all words.
  void add_repeated(const std::string& names, const std::string& placeholder, const std::string& help, Setter set);
  /// Adds a required option of this kind. It may be an argument without a dash.
  void add_required_repeated(const std::string& names, const std::string& placeholder, const std::string& help,
                             Setter set);
  /// Adds an option with one word that help and suggestions do not name. Its setter refuses it.
  void add_hidden(const std::string& name, Setter set);
  void add_flag(const std::string& names, const std::string& help, bool& value);

 private:
  CLI::App& command_;
};

/// A command of the program. `app` has its options, and `run` does its work.
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

/// Adds a command with --help and --version.
CLI::App& add_command(CLI::App& program, const std::string& name, const std::string& help);

/// Adds the options that the program and each of its commands have.
void add_common_options(CLI::App& app);

/// Reads the command line. Returns false if the command line requests help or the version, which the function then
/// prints. Throws UsageError.
bool parse_arguments(CLI::App& program, int argc, const char* const* argv);

}  // namespace promin::app
