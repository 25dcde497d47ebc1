// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/typed_words.h"

#include <CLI/App.hpp>
#include <CLI/Option.hpp>
#include <algorithm>
#include <filesystem>
#include <utility>

#include "options/arguments.h"

namespace promin::app {
namespace {

constexpr const char* kRender = "render";
constexpr std::string_view kSize = "--size";
constexpr std::string_view kAnimation = "--animation";
constexpr std::string_view kWidth = "--width";
constexpr std::string_view kHeight = "--height";

/// Another program's name for an option or a command.
struct OtherName {
  std::string_view typed;
  std::string_view own;
};

/// Names of other programs that are unambiguous and take the same values.
constexpr OtherName kSameOptions[] = {
    {"--resolution", kSize}, {"--samples", "--spp"}, {"--transparent", "--alpha"}, {"--num-threads", "--threads"}};

/// Names of other programs with other values or a slightly different meaning. If a name has several rows, the first row
/// with an option of the command applies.
constexpr OtherName kNearOptions[] = {{"--aa", "--spp"},
                                      {"--animation", "--path"},
                                      {"--antialiasing", "--spp"},
                                      {"--aovs", "--aov"},
                                      {"--aperture", "--fov"},
                                      {"--background-color", "--background"},
                                      {"--bg", "--background"},
                                      {"--bounces", "--max-depth"},
                                      {"--brightness", "--exposure"},
                                      {"--camera-position", "--eye"},
                                      {"--channels", "--aov"},
                                      {"--cores", "--threads"},
                                      {"--debug", "--shading"},
                                      {"--dimensions", kSize},
                                      {"--env", "--environment"},
                                      {"--envmap", "--environment"},
                                      {"--ev", "--exposure"},
                                      {"--field-of-view", "--fov"},
                                      {"--file", "--output"},
                                      {"--format", "--output"},
                                      {"--frame", "--frames"},
                                      {"--framerate", "--fps"},
                                      {"--gamma", "--tone-mapping"},
                                      {"--geometry", kSize},
                                      {"--gpu", "--device"},
                                      {"--hdr", "--environment"},
                                      {"--hdri", "--environment"},
                                      {"--ibl", "--environment"},
                                      {"--image-size", kSize},
                                      {"--jobs", "--threads"},
                                      {"--layers", "--aov"},
                                      {"--lighting", "--light"},
                                      {"--max-time", "--time-limit"},
                                      {"--msaa", "--spp"},
                                      {"--no-background", "--alpha"},
                                      {"--noise", "--target-error"},
                                      {"--normals", "--shading"},
                                      {"--outfile", "--output"},
                                      {"--output-file", "--output"},
                                      {"--output-format", "--output"},
                                      {"--passes", "--aov"},
                                      {"--position", "--eye"},
                                      {"--recursion", "--max-depth"},
                                      {"--region", "--crop"},
                                      {"--resume", "--job"},
                                      {"--sample", "--spp"},
                                      {"--silent", "--quiet"},
                                      {"--skybox", "--environment"},
                                      {"--target", "--look-at"},
                                      {"--threshold", "--fail"},
                                      {"--threshold", "--target-error"},
                                      {"--time", "--time-limit"},
                                      {"--timeout", "--time-limit"},
                                      {"--tolerance", "--fail"},
                                      {"--tolerance", "--target-error"},
                                      {"--tonemap", "--tone-mapping"},
                                      {"--tonemapping", "--tone-mapping"},
                                      {"--transparent-background", "--alpha"},
                                      {"--transparent-bg", "--alpha"},
                                      {"--turntable", "--path"},
                                      {"--view", "--from"},
                                      {"--viewpoint", "--from"},
                                      {"--wireframe", "--shading"}};

/// Names of other programs for commands.
constexpr OtherName kNearCommands[] = {
    {"diff", "compare"}, {"gpus", "devices"}, {"inspect", "info"}, {"montage", "contact-sheet"}};

bool has_option(const CLI::App& command, std::string_view name) {
  return command.get_option_no_throw(std::string(name)) != nullptr;
}

bool is_command(const CLI::App& program, const std::string& word) {
  return std::ranges::any_of(commands_of(program), [&](const CLI::App* each) { return each->get_name() == word; });
}

const CLI::App& find_command(const CLI::App& program, const std::vector<std::string>& words) {
  const auto word = std::ranges::find_if(words, [&](const std::string& each) { return is_command(program, each); });
  return word == words.end() ? program : *program.get_subcommand(*word);
}

/// Removes "--name VALUE" or "--name=VALUE" from the words and returns the value. If it occurs several times, the last
/// one counts.
std::optional<std::string> take_value(std::vector<std::string>& words, std::string_view name, size_t& place) {
  std::optional<std::string> value;
  for (size_t i = 1; i < words.size();) {
    const bool is_alone = words[i] == name && i + 1 < words.size();
    if (!is_alone && !words[i].starts_with(std::string(name) + "=")) {
      ++i;
      continue;
    }
    value = is_alone ? words[i + 1] : words[i].substr(name.size() + 1);
    const auto begin = words.begin() + static_cast<std::ptrdiff_t>(i);
    words.erase(begin, begin + (is_alone ? 2 : 1));
    place = i;
  }
  return value;
}

/// Spells out -w and -h before a number. In other places -h means help.
void spell_sides(std::vector<std::string>& words) {
  for (size_t i = 1; i + 1 < words.size(); ++i) {
    if (!is_number(words[i + 1])) continue;
    if (words[i] == "-w") words[i] = kWidth;
    if (words[i] == "-h") words[i] = kHeight;
  }
}

/// Joins --width and --height to --size.
void join_sides(std::vector<std::string>& words) {
  size_t place = 0;
  const std::optional<std::string> width = take_value(words, kWidth, place);
  const std::optional<std::string> height = take_value(words, kHeight, place);
  if (!width && !height) return;
  const std::string size = width.value_or("") + (height ? "x" + *height : "");
  words.insert(words.begin() + static_cast<std::ptrdiff_t>(place), {std::string(kSize), size});
}

/// Joins the two words of --size W H to one.
void join_size(std::vector<std::string>& words) {
  for (size_t i = 1; i + 2 < words.size(); ++i) {
    if (words[i] != kSize || !is_number(words[i + 1]) || !is_number(words[i + 2])) continue;
    words[i + 1] += "x" + words[i + 2];
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(i) + 2);
  }
}

/// Returns whether all parts are numbers, and there are as many as the option accepts.
bool are_values_of(const CLI::Option* option, const std::vector<std::string>& parts) {
  return option != nullptr && parts.size() > 1 && std::cmp_equal(parts.size(), option->get_type_size()) &&
         std::ranges::all_of(parts, is_number);
}

/// Splits the value of --eye X,Y,Z, and of all other options with several numbers, into words.
void split_numbers(const CLI::App& command, std::vector<std::string>& words) {
  for (size_t i = 1; i < words.size(); ++i) {
    const size_t equals = words[i].find('=');
    const bool is_joined = equals != std::string::npos;
    if (!words[i].starts_with("--") || (!is_joined && i + 1 == words.size())) continue;
    const std::string name = words[i].substr(0, equals);
    const std::vector<std::string> parts = split_list(is_joined ? words[i].substr(equals + 1) : words[i + 1]);
    if (!are_values_of(command.get_option_no_throw(name), parts)) continue;
    words[i] = name;
    const auto values = words.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    words.insert(is_joined ? values : words.erase(values), parts.begin(), parts.end());
  }
}

/// Changes --up Z to --up z.
void lower_axes(std::vector<std::string>& words) {
  for (size_t i = 2; i < words.size(); ++i) {
    if (words[i - 1] != "--up" || words[i].empty() || words[i].size() > 2) continue;
    char& axis = words[i].back();
    if (axis >= 'X' && axis <= 'Z') axis = static_cast<char>(axis - 'X' + 'x');
  }
}

/// Changes --animation 0 1 to --animation 0 --animation 1.
void repeat_animations(std::vector<std::string>& words) {
  const auto is_index = [](const std::string& word) {
    return !word.empty() && word.find_first_not_of("0123456789") == std::string::npos;
  };
  for (size_t i = 2; i < words.size(); ++i) {
    const bool is_further = words[i - 2] == kAnimation && is_index(words[i - 1]) && is_index(words[i]);
    if (is_further) words.insert(words.begin() + static_cast<std::ptrdiff_t>(i++), std::string(kAnimation));
  }
}

/// Returns whether a word must be a file, existing or not. A folder counts as a file here, and is refused later.
bool names_file(const std::string& word) {
  std::error_code error;
  return !word.starts_with('-') &&
         (word.find_first_of("./") != std::string::npos || std::filesystem::exists(word, error));
}

void add_render(const CLI::App& program, std::vector<std::string>& words) {
  if (!is_command(program, kRender) || words.size() < 2) return;
  const auto is_one = [&](const std::string& each) { return is_command(program, each); };
  const bool has_command = std::any_of(words.begin() + 1, words.end(), is_one);
  const bool has_file = std::any_of(words.begin() + 1, words.end(), names_file);
  const bool begins_with_option = words[1].starts_with('-') && has_file && !has_command;
  if (!is_one(words[1]) && (names_file(words[1]) || begins_with_option)) words.insert(words.begin() + 1, kRender);
}

/// Converts "promin help render" and "promin version" to options of the command or the program. Returns false for other
/// words.
bool turn_words_to_options(const CLI::App& program, std::vector<std::string>& words) {
  if (words.size() < 2 || commands_of(program).empty()) return false;
  if (words[1] == "version") {
    words[1] = "--version";
    return true;
  }
  if (words[1] != "help") return false;
  words.erase(words.begin() + 1);
  // A word that is not a command is refused.
  if (words.size() == 1 || is_command(program, words[1])) words.emplace_back("--help");
  return true;
}

}  // namespace

std::vector<std::string> spell_out(const CLI::App& program, const std::vector<std::string>& words) {
  std::vector<std::string> spelt = words;
  if (!turn_words_to_options(program, spelt)) add_render(program, spelt);
  const CLI::App& command = find_command(program, spelt);
  for (const OtherName& other : kSameOptions) {
    if (!has_option(command, other.own) || has_option(command, other.typed)) continue;
    for (std::string& word : spelt) {
      if (word.substr(0, word.find('=')) == other.typed) word.replace(0, other.typed.size(), other.own);
    }
  }
  split_numbers(command, spelt);
  lower_axes(spelt);
  if (has_option(command, kAnimation)) repeat_animations(spelt);
  if (!has_option(command, kSize)) return spelt;
  spell_sides(spelt);
  join_sides(spelt);
  join_size(spelt);
  return spelt;
}

std::string find_by_meaning(const CLI::App& command, std::string_view typed) {
  const auto* const found = std::ranges::find_if(
      kNearOptions, [&](const OtherName& other) { return other.typed == typed && has_option(command, other.own); });
  return found == std::end(kNearOptions) ? "" : std::string(found->own);
}

std::string find_command_by_meaning(const CLI::App& program, std::string_view typed) {
  const auto* const found = std::ranges::find_if(kNearCommands, [&](const OtherName& other) {
    return other.typed == typed && is_command(program, std::string(other.own));
  });
  return found == std::end(kNearCommands) ? "" : std::string(found->own);
}

}  // namespace promin::app
