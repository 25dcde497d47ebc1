// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/manual.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

#include "options/arguments.h"

namespace promin::app {
namespace {

/// Returns the program itself and its commands: all parts that have options.
std::vector<const CLI::App*> with_commands(const CLI::App& program) {
  std::vector<const CLI::App*> all = {&program};
  for (const CLI::App* command : commands_of(program)) all.push_back(command);
  return all;
}

/// Returns the names of an option, such as "-o" and "--output", the short ones first.
std::vector<std::string> names_of_option(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  return app.get_options(
      [](const CLI::Option* option) { return !option->get_positional() && !option->get_group().empty(); });
}

std::vector<const CLI::Option*> positionals_of(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

bool takes_values(const CLI::Option& option) {
  return option.get_items_expected_max() > 0 && !option.get_type_name().empty();
}

/// Returns the literal words that an option accepts: for "EV|auto|average" the last two. Placeholders are in capitals.
std::vector<std::string> words_of(const CLI::Option& option) {
  std::vector<std::string> words;
  std::istringstream alternatives(option.get_type_name());
  for (std::string word; std::getline(alternatives, word, '|');) {
    const bool is_word = std::ranges::none_of(
        word, [](unsigned char c) { return std::isupper(c) != 0 || std::isspace(c) != 0 || c == '.'; });
    if (is_word && !word.empty()) words.push_back(word);
  }
  return words;
}

std::string replace_all(std::string text, std::string_view from, std::string_view to) {
  for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// The following functions make the manual page.

/// Escapes text for roff: hyphens, and lines that would be read as a request.
std::string roff(const std::string& text) {
  const std::string escaped = replace_all(replace_all(text, "\\", "\\e"), "-", "\\-");
  return escaped.starts_with(".") || escaped.starts_with("'") ? "\\&" + escaped : escaped;
}

std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string man_options(const CLI::App& app) {
  std::string page;
  for (const CLI::Option* option : positionals_of(app)) {
    page += fmt::format(".TP\n.I {}\n{}\n", roff(option->get_name(true)), roff(option->get_description()));
  }
  for (const CLI::Option* option : options_of(app)) {
    const std::string names = fmt::format("{}", fmt::join(names_of_option(*option), ", "));
    const std::string values = takes_values(*option) ? " \\fI" + roff(option->get_type_name()) + "\\fR" : "";
    page += fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(names), values, roff(option->get_description()));
  }
  return page;
}

std::string synopsis_of(const CLI::App& program, const CLI::App& app) {
  std::string line = ".B " + roff(program.get_name());
  if (&app != &program) line += " " + app.get_name();
  line += "\n[\\fIOPTIONS\\fR]";
  for (const CLI::Option* option : positionals_of(app)) {
    const std::string name = roff(option->get_name(true)) + (option->get_expected_max() > 1 ? "..." : "");
    line += option->get_required() ? " \\fI" + name + "\\fR" : " [\\fI" + name + "\\fR]";
  }
  return line + "\n";
}

std::string make_man(const CLI::App& program) {
  const std::string name = program.get_name();
  const std::string summary = program.get_description();
  std::string page = fmt::format(".\\\" Made from the option tables of {}.\n.TH {} 1 \"\" \"promin {}\" \"promin\"\n",
                                 name, upper_case(roff(name)), PROMIN_VERSION);
  page += fmt::format(".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n", roff(name), roff(summary));
  const std::vector<const CLI::App*> commands = commands_of(program);
  if (commands.empty()) page += synopsis_of(program, program);
  for (const CLI::App* command : commands) {
    page += (command == commands.front() ? "" : ".br\n") + synopsis_of(program, *command);
  }
  page += fmt::format(".SH DESCRIPTION\n{}\n.SH OPTIONS\n{}", roff(summary), man_options(program));
  if (!commands.empty()) page += ".SH COMMANDS\n";
  for (const CLI::App* command : commands) {
    page += fmt::format(".SS {}\n{}.\n{}", roff(command->get_name()), roff(command->get_description()),
                        man_options(*command));
  }
  page +=
      ".SH EXIT STATUS\n"
      ".TP\n0\nDone.\n"
      ".TP\n1\nA failure at run time, such as input or output, memory, or a lost device.\n"
      ".TP\n2\nThe command line is wrong.\n"
      ".TP\n3\nA bad scene, ray or BVH file, or picture.\n"
      ".TP\n4\nThere is no usable Vulkan device, or no display for the window.\n"
      ".TP\n5\nPictures differ by more than was allowed.\n"
      ".SH ENVIRONMENT\n"
      ".TP\n.B PROMIN_VALIDATION\nRuns under the Vulkan validation layers: core or sync.\n"
      ".TP\n.B PROMIN_PLUGINS\nThe folder of libpromin_pictures.so, which reads and writes pictures.\n"
      ".SH SEE ALSO\n.BR promin (1),\n.BR promin\\-view (1),\n.BR promin\\-bvh (1)\n";
  return page;
}

// The following functions make completions. Arguments are completed with files, and so are values of options without
// literal words.

std::string bash_words(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options_of(app)) {
    for (std::string& name : names_of_option(*option)) names.push_back(std::move(name));
  }
  return fmt::format("{}", fmt::join(names, " "));
}

std::string make_bash(const CLI::App& program) {
  const std::string name = program.get_name();
  const std::string function = "_" + replace_all(name, "-", "_");
  std::string commands;
  for (const CLI::App* command : commands_of(program)) commands += (commands.empty() ? "" : " ") + command->get_name();
  std::string cases;
  std::string options;
  for (const CLI::App* app : with_commands(program)) {
    const std::string pattern = app == &program ? "''" : app->get_name();
    options += fmt::format("    {}) options='{}' ;;\n", pattern, bash_words(*app));
    for (const CLI::Option* option : options_of(*app)) {
      const std::vector<std::string> words = words_of(*option);
      if (!takes_values(*option) || words.empty()) continue;
      for (const std::string& each : names_of_option(*option)) {
        cases += fmt::format("    {}:{}) words='{}' ;;\n", pattern, each, fmt::join(words, " "));
      }
    }
  }
  return fmt::format(R"(# Completion of {0} for bash, made from its option tables.
{1}() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} command='' options='' words='' i
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case " {2} " in *" ${{COMP_WORDS[i]}} "*) command=${{COMP_WORDS[i]}}; break ;; esac
  done
  case $command:$before in
{3}  esac
  case $command in
{4}  esac
  COMPREPLY=()
  if [[ -n $words ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  elif [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$word")
  elif [[ -z $command && -n '{2}' ]]; then
    mapfile -t COMPREPLY < <(compgen -W '{2}' -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
    compopt -o filenames 2> /dev/null
  fi
}}
complete -F {1} {0}
)",
                     name, function, commands, cases, options);
}

/// Escapes a text for a single-quoted argument of zsh's _arguments, in which brackets and colons are separators.
std::string zsh_text(const std::string& text) {
  std::string escaped = text;
  for (const char* sign : {"\\", "[", "]", ":"}) escaped = replace_all(escaped, sign, std::string("\\") + sign);
  return replace_all(escaped, "'", "'\\''");
}

std::string zsh_arguments(const CLI::App& app, const std::string& indent) {
  std::string lines;
  for (const CLI::Option* option : options_of(app)) {
    const std::vector<std::string> words = words_of(*option);
    std::string values;
    for (int i = 0; takes_values(*option) && i < std::max(option->get_type_size(), 1); ++i) {
      const std::string action = words.empty() ? "_files" : fmt::format("({})", fmt::join(words, " "));
      values += fmt::format(":{}:{}", zsh_text(option->get_type_name()), action);
    }
    for (const std::string& each : names_of_option(*option)) {
      lines += fmt::format(" \\\n{}'*{}[{}]{}'", indent, each, zsh_text(option->get_description()), values);
    }
  }
  return lines + fmt::format(" \\\n{}'*:file:_files'\n", indent);
}

std::string make_zsh(const CLI::App& program) {
  const std::string name = program.get_name();
  std::string script = fmt::format("#compdef {0}\n# Completion of {0} for zsh, made from its option tables.\n", name);
  const std::vector<const CLI::App*> commands = commands_of(program);
  if (commands.empty()) return script + "_arguments" + zsh_arguments(program, "  ");
  script += "local -a commands=(\n";
  for (const CLI::App* command : commands) {
    script += fmt::format("  '{}:{}'\n", command->get_name(), zsh_text(command->get_description()));
  }
  script += ")\nif (( CURRENT == 2 )); then\n  _describe command commands\n  _arguments" +
            zsh_arguments(program, "    ") + "  return\nfi\ncase $words[2] in\n";
  for (const CLI::App* command : commands) {
    script += fmt::format("  {})\n    _arguments{}    ;;\n", command->get_name(), zsh_arguments(*command, "      "));
  }
  return script + "esac\n";
}

std::string fish_text(const std::string& text) {
  return replace_all(replace_all(text, "\\", "\\\\"), "'", "\\'");
}

std::string make_fish(const CLI::App& program) {
  const std::string name = program.get_name();
  std::string script = fmt::format("# Completion of {} for fish, made from its option tables.\n", name);
  for (const CLI::App* command : commands_of(program)) {
    script += fmt::format("complete -c {} -n __fish_use_subcommand -f -a {} -d '{}'\n", name, command->get_name(),
                          fish_text(command->get_description()));
  }
  for (const CLI::App* app : with_commands(program)) {
    std::string condition;
    if (app != &program) condition = fmt::format(" -n '__fish_seen_subcommand_from {}'", app->get_name());
    if (app == &program && !commands_of(program).empty()) condition = " -n __fish_use_subcommand";
    for (const CLI::Option* option : options_of(*app)) {
      script += fmt::format("complete -c {}{}", name, condition);
      for (const std::string& each : option->get_snames()) script += " -s " + each;
      for (const std::string& each : option->get_lnames()) script += " -l " + each;
      const std::vector<std::string> words = words_of(*option);
      if (takes_values(*option)) script += words.empty() ? " -r" : fmt::format(" -x -a '{}'", fmt::join(words, " "));
      script += fmt::format(" -d '{}'\n", fish_text(option->get_description()));
    }
  }
  return script;
}

}  // namespace

std::optional<std::string> make_manual(const CLI::App& program, std::string_view kind) {
  if (kind == "man") return make_man(program);
  if (kind == "bash") return make_bash(program);
  if (kind == "zsh") return make_zsh(program);
  if (kind == "fish") return make_fish(program);
  return std::nullopt;
}

}  // namespace promin::app
