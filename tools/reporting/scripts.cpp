// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/scripts.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>

#include "promin/error.h"

extern char** environ;

namespace promin::report {
namespace {

/// PROMIN_PYTHON, or the system's, for which matplotlib is packaged.
std::string find_python() {
  if (const char* given = std::getenv("PROMIN_PYTHON"); given != nullptr && *given != '\0') return given;
  constexpr const char* kSystems = "/usr/bin/python3";
  return access(kSystems, X_OK) == 0 ? kSystems : "python3";
}

std::vector<std::string> script_words(const std::string& name, const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {find_python(), std::string(PROMIN_TOOLS_DIR) + "/reporting/" + name};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

/// Waits for a process; whether it ended with 0.
bool has_succeeded(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) return false;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::string read_all(int file) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t count = 0; (count = read(file, buffer.data(), buffer.size())) != 0;) {
    if (count > 0) {
      text.append(buffer.data(), static_cast<size_t>(count));
    } else if (errno != EINTR) {
      break;
    }
  }
  return text;
}

/// Without white space around it; empty lines do not count.
std::string last_line_of(const std::string& text) {
  const size_t last = text.find_last_not_of(" \t\r\n");
  if (last == std::string::npos) return {};
  const size_t line = text.find_last_of('\n', last);
  const size_t first = text.find_first_not_of(" \t\r", line == std::string::npos ? 0 : line + 1);
  return text.substr(first, last + 1 - first);
}

}  // namespace

ProgramResult run_program(const std::vector<std::string>& words) {
  std::array<int, 2> ends{};
  // In memory, as a pipe that nobody reads would stop the program.
  const int errors = memfd_create("errors", MFD_CLOEXEC);
  if (errors < 0 || pipe2(ends.data(), O_CLOEXEC) != 0) {
    if (errors >= 0) close(errors);
    return {false, "", "no file for its output"};
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const bool has_started = posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  ProgramResult result;
  if (has_started) {
    result.output = read_all(ends[0]);
    result.has_succeeded = has_succeeded(process);
    lseek(errors, 0, SEEK_SET);
    const std::string said = read_all(errors);
    std::fputs(said.c_str(), stderr);
    result.last_line = last_line_of(said);
  } else {
    result.last_line = words[0] + " cannot be run";
  }
  close(ends[0]);
  close(errors);
  return result;
}

std::string describe_commit() {
  const std::string folder = PROMIN_TOOLS_DIR;
  const ProgramResult commit = run_program({"git", "-C", folder, "describe", "--always"});
  if (!commit.has_succeeded) return "unknown";
  // Reports themselves lie in docs; no program is made of what does.
  const ProgramResult same =
      run_program({"git", "-C", folder, "diff", "--quiet", "HEAD", "--", ":/", ":(top,exclude)docs"});
  return last_line_of(commit.output) + (same.has_succeeded ? "" : "-dirty");
}

ScriptResult run_script(const std::string& name, const std::vector<std::string>& arguments) {
  const ProgramResult script = run_program(script_words(name, arguments));
  Json json = Json::parse(script.output, nullptr, false);
  if (script.has_succeeded && !json.is_discarded()) return {std::move(json), std::nullopt};
  return {Json(), script.last_line.empty() ? name + " failed without a word" : script.last_line};
}

void make_page(const Session& session) {
  const ReportOptions& options = session.options();
  std::vector<std::string> arguments = {options.output.string()};
  if (options.compare) arguments.insert(arguments.end(), {"--compare", options.compare->string()});
  const ProgramResult page = run_program(script_words("page.py", arguments));
  if (!page.has_succeeded) {
    throw RunError({"report.html could not be made", options.output.string(),
                    "report.json and the CSV files are there; install python3, and see what it says above"});
  }
  if (!page.output.empty()) session.say(page.output.substr(0, page.output.find_last_not_of('\n') + 1));
}

}  // namespace promin::report
