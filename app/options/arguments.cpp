// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <sstream>

#include "core/parse_number.h"
#include "core/suggest.h"
#include "options/typed_words.h"
#include "promin/error.h"
#include "promin/image.h"

namespace promin::app {
namespace {

/// The largest numerator and denominator of a fraction.
constexpr double kMostOfFraction = 1e9;

/// Returns the advice for a wrong word. `near` is the word that the user may have meant, if known.
std::string cure_for(const std::string& command, std::string_view near = {}) {
  return near.empty() ? fmt::format("see {} --help", command) : fmt::format("did you mean {}?", near);
}

std::string tell_too_few(const std::string& option, const std::string& placeholders) {
  return fmt::format("too few values are given for {} {}", option, placeholders);
}

/// Returns the name of a command with its program: "promin render" for the command "render".
std::string path_of(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name() : app.get_parent()->get_name() + " " + app.get_name();
}

/// Returns the name of an option for messages: the last name of "-s,--spp".
std::string display_name(const std::string& names) {
  return names.substr(names.rfind(',') + 1);
}

const CLI::App& deepest_command(const CLI::App& program) {
  const auto commands = program.get_subcommands();
  return commands.empty() ? program : *commands.front();
}

std::string nearest_of(const std::string& name, const std::vector<std::string>& names) {
  const std::vector<std::string_view> known(names.begin(), names.end());
  return std::string(nearest_name(name, known));
}

/// Returns the command's option with the same meaning, or otherwise with the most similar name; empty if none is
/// similar.
std::string nearest_option(const std::string& name, const CLI::App& command) {
  const std::string meant = find_by_meaning(command, name);
  if (!meant.empty()) return meant;
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    for (const std::string& known : option->get_lnames()) names.push_back(known);
  }
  // Leading dashes are removed, because they do not count as common letters.
  const std::string near = nearest_of(name.substr(std::min(name.find_first_not_of('-'), name.size())), names);
  return near.empty() ? "" : "--" + near;
}

/// Returns the program's command with the same meaning or the most similar name; empty if none is similar.
std::string nearest_command(const std::string& name, const CLI::App& program) {
  const std::string meant = find_command_by_meaning(program, name);
  if (!meant.empty()) return meant;
  std::vector<std::string> names;
  for (const CLI::App* command : commands_of(program)) names.push_back(command->get_name());
  return nearest_of(name, names);
}

/// Refuses the words that CLI11 collects: unknown options, unknown commands and surplus words.
void refuse_leftovers(const CLI::App& program) {
  std::vector<std::string> leftovers = program.remaining(true);
  leftovers.erase(std::remove(leftovers.begin(), leftovers.end(), "--"), leftovers.end());
  if (leftovers.empty()) return;
  const auto is_option = [](const std::string& word) { return word.size() > 1 && word.front() == '-'; };
  const auto option = std::find_if(leftovers.begin(), leftovers.end(), is_option);
  const CLI::App& command = deepest_command(program);
  const std::string path = path_of(command);
  // A program without commands is itself the command.
  const bool lacks_command = &command == &program && !commands_of(program).empty();
  const bool begins_with_word = lacks_command && option != leftovers.begin();
  if (option != leftovers.end() && !begins_with_word) {
    const std::string name = option->substr(0, option->find('='));
    throw UsageError(
        {"usage.option.unknown", "there is no option " + name, "", cure_for(path, nearest_option(name, command))});
  }
  const std::string& word = leftovers.front();
  if (!lacks_command) {
    const bool is_output = is_writable_format(word) && command.get_option_no_throw("--output") != nullptr;
    throw UsageError({"usage.argument.unexpected", "the argument " + word + " is not expected", "",
                      is_output ? "write -o " + word : cure_for(path)});
  }
  throw UsageError(
      {"usage.command.unknown", "there is no command " + word, "", cure_for(path, nearest_command(word, program))});
}

/// Words each of which replaces all values of an option.
struct Alternative {
  std::vector<std::string> words;
  size_t count = 0;

  bool has(std::string_view word) const {
    return std::ranges::find(words, word) != words.end() || (takes_any() && is_no_number(word));
  }

 private:
  /// Returns whether the alternative is a placeholder, which stands for any word that is neither a number nor an
  /// option.
  bool takes_any() const {
    const auto is_upper = [](unsigned char c) { return std::isupper(c) != 0; };
    return std::ranges::any_of(words, [&](const std::string& word) { return std::ranges::all_of(word, is_upper); });
  }
  static bool is_no_number(std::string_view word) {
    return !word.empty() && word.front() != '-' && !is_number(std::string(word));
  }
};

/// Returns the parts of "R G B|WORD|OTHER" after the first.
std::vector<std::string> split_alternatives(const std::string& placeholders) {
  std::vector<std::string> words;
  for (size_t bar = placeholders.find('|'); bar != std::string::npos;) {
    const size_t next = placeholders.find('|', bar + 1);
    words.push_back(placeholders.substr(bar + 1, next - bar - 1));
    bar = next;
  }
  return words;
}

/// Collects the alternatives of all options of a program, by the options' names.
void find_alternatives(const CLI::App& app, std::map<std::string, Alternative>& found) {
  for (const CLI::Option* option : app.get_options()) {
    const std::vector<std::string> words = split_alternatives(option->get_type_name());
    if (option->get_type_size() < 2 || words.empty()) continue;
    for (const std::string& name : option->get_lnames()) {
      found[std::string("--").append(name)] = {words, static_cast<size_t>(option->get_type_size())};
    }
  }
  for (const CLI::App* command : commands_of(app)) find_alternatives(*command, found);
}

/// Returns the words of a command line, in which each alternative is repeated as often as its option has values. CLI11
/// always gives an option the same number of words.
std::vector<const char*> fill_up_alternatives(const std::vector<std::string>& words,
                                              const std::map<std::string, Alternative>& alternatives) {
  std::vector<const char*> filled;
  for (size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    filled.push_back(word.c_str());
    for (const auto& [name, alternative] : alternatives) {
      const bool is_joined = word.starts_with(name + "=") && alternative.has(word.substr(name.size() + 1));
      const bool is_alone = i > 0 && words[i - 1] == name && alternative.has(word);
      if (is_alone || is_joined) {
        filled.insert(filled.end(), alternative.count - 1, word.c_str() + (is_joined ? name.size() + 1 : 0));
      }
    }
  }
  return filled;
}

}  // namespace

bool is_number(const std::string& word) {
  return to_number<double>(word).has_value();
}

std::vector<std::string> split_list(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream rest(list + ",");
  for (std::string part; std::getline(rest, part, ',');) parts.push_back(part);
  return parts;
}

std::vector<const CLI::App*> commands_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

/// Throws UsageError if an option follows in place of a value, because values are then missing.
void OptionValues::refuse_option(size_t i) const {
  const std::string& word = words_[i];
  const bool is_option = word.size() > 1 && word[0] == '-' &&
                         (word[1] == '-' || (std::isalpha(static_cast<unsigned char>(word[1])) != 0 && word != "-inf"));
  if (is_option) throw UsageError({"usage.option.few", tell_too_few(option_, placeholders_), "", cure_for(command_)});
}

void OptionValues::refuse(const std::string& what, std::string_view near) const {
  throw UsageError({"usage.option.value", what, "", cure_for(command_, near)});
}

std::string OptionValues::quote(size_t i) const {
  if (whole_word_.empty() || whole_word_ == words_[i]) return fmt::format("\"{}\"", words_[i]);
  return fmt::format("\"{}\" in \"{}\"", words_[i], whole_word_);
}

uint32_t OptionValues::whole(size_t i, uint32_t min, uint32_t max) const {
  const std::optional<uint32_t> number = to_number<uint32_t>(words_[i]);
  if (!number || *number < min || *number > max) {
    refuse_option(i);
    refuse(fmt::format("{} takes a whole number from {} to {}, not {}", option_, min, max, quote(i)));
  }
  return *number;
}

double OptionValues::real(size_t i, double min, double max, std::span<const std::string_view> others) const {
  const std::optional<double> number = to_number<double>(words_[i]);
  // The condition is written so that a NaN is refused.
  if (!number || !(*number >= min && *number <= max)) {
    refuse_option(i);
    const std::string range = fmt::format("a number from {:g} to {:g}", min, max);
    std::vector<std::string_view> choices = {range};
    choices.insert(choices.end(), others.begin(), others.end());
    refuse(fmt::format("{} takes {}, not {}", option_, list_choices(choices), quote(i)),
           nearest_name(words_[i], others));
  }
  return *number;
}

std::optional<double> OptionValues::fraction() const {
  const size_t bar = text().find('/');
  if (bar == std::string::npos) return std::nullopt;
  const OptionValues parts = with({text().substr(0, bar), text().substr(bar + 1)});
  return parts.real(0, 0.0, kMostOfFraction) / parts.real(1, 1.0, kMostOfFraction);
}

dvec3 OptionValues::vector(double max) const {
  return {real(0, -max, max), real(1, -max, max), real(2, -max, max)};
}

const std::string& OptionValues::choice(std::span<const std::string_view> choices) const {
  if (std::find(choices.begin(), choices.end(), text()) == choices.end()) {
    refuse(fmt::format("{} takes {}, not \"{}\"", option_, list_choices(choices), text()),
           nearest_name(text(), choices));
  }
  return text();
}

OptionTable::OptionTable(CLI::App& command) : command_(command) {}

void OptionTable::add(const std::string& names, const std::string& placeholders, const std::string& help, Setter set) {
  const auto count = static_cast<int>(std::count(placeholders.begin(), placeholders.end(), ' ')) + 1;
  const auto receive = [path = path_of(command_), name = display_name(names), placeholders,
                        set = std::move(set)](const std::vector<std::string>& words) {
    set(OptionValues(path, name, placeholders, words));
    return true;
  };
  CLI::Option* option = command_.add_option(names, CLI::callback_t(receive), help);
  option->type_name(placeholders)->type_size(count)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

void OptionTable::add_required(const std::string& names, const std::string& placeholders, const std::string& help,
                               Setter set) {
  add(names, placeholders, help, std::move(set));
  command_.get_option(display_name(names))->required();
}

void OptionTable::add_repeated(const std::string& names, const std::string& placeholder, const std::string& help,
                               Setter set) {
  add(names, placeholder, help, std::move(set));
  command_.get_option(display_name(names))->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void OptionTable::add_required_repeated(const std::string& names, const std::string& placeholder,
                                        const std::string& help, Setter set) {
  add_repeated(names, placeholder, help, std::move(set));
  CLI::Option* option = command_.get_option(display_name(names))->required();
  // A positional argument accepts one word or more.
  if (option->get_positional()) option->expected(1, -1)->allow_extra_args();
}

void OptionTable::add_hidden(const std::string& name, Setter set) {
  add(name, "", "", std::move(set));
  command_.get_option(name)->group("");
}

void OptionTable::add_flag(const std::string& names, const std::string& help, bool& value) {
  command_.add_flag(names, value, help);
}

CLI::App& add_command(CLI::App& program, const std::string& name, const std::string& help) {
  CLI::App* command = program.add_subcommand(name, help);
  // Without this, the command would inherit the program's examples.
  command->footer("");
  add_common_options(*command);
  return *command;
}

void add_common_options(CLI::App& app) {
  app.allow_extras();
  app.set_help_flag("-h,--help", "Print this help and exit");
  const CLI::App& program = app.get_parent() == nullptr ? app : *app.get_parent();
  app.set_version_flag("--version", program.get_name() + " " + PROMIN_VERSION, "Print the version and exit");
}

bool parse_arguments(CLI::App& program, int argc, const char* const* argv) {
  std::map<std::string, Alternative> alternatives;
  find_alternatives(program, alternatives);
  const std::vector<std::string> spelt = spell_out(program, {argv, argv + argc});
  const std::vector<const char*> words = fill_up_alternatives(spelt, alternatives);
  try {
    program.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::CallForHelp&) {
    fmt::print("{}", program.help());
    return false;
  } catch (const CLI::CallForVersion& version) {
    fmt::print("{}\n", version.what());
    return false;
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string message = error.what();
    const std::string name = message.substr(0, message.find(':'));
    const CLI::App& command = deepest_command(program);
    const CLI::Option* option = command.get_option_no_throw(name);
    const std::string placeholders = option == nullptr ? "" : option->get_type_name();
    throw UsageError({"usage.option.few", tell_too_few(name, placeholders), "", cure_for(path_of(command))});
  } catch (const CLI::ParseError& error) {
    // Misspelt options are reported before missing ones, because that message is more useful.
    refuse_leftovers(program);
    const std::string message = error.what();
    throw UsageError(
        {"usage.words.wrong", message.substr(0, message.find('\n')), "", cure_for(path_of(deepest_command(program)))});
  }
  refuse_leftovers(program);
  return true;
}

}  // namespace promin::app
