// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/scripts.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "core/error.h"

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

}  // namespace

std::optional<std::string> read_output(const std::vector<std::string>& words) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return std::nullopt;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  posix_spawn_file_actions_addclose(&actions, ends[1]);
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const bool has_started = posix_spawnp(&process, arguments[0], &actions, nullptr, arguments.data(), environ) == 0;
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string output;
  std::array<char, 4096> buffer{};
  for (ssize_t count = 0; has_started && (count = read(ends[0], buffer.data(), buffer.size())) > 0;) {
    output.append(buffer.data(), static_cast<size_t>(count));
  }
  close(ends[0]);
  if (!has_started || !has_succeeded(process)) return std::nullopt;
  return output;
}

std::string describe_commit() {
  std::string commit =
      read_output({"git", "-C", PROMIN_TOOLS_DIR, "describe", "--always", "--dirty"}).value_or("unknown");
  while (!commit.empty() && commit.back() == '\n') commit.pop_back();
  return commit;
}

Json run_script(const std::string& name, const std::vector<std::string>& arguments) {
  const std::optional<std::string> output = read_output(script_words(name, arguments));
  if (!output) return {};
  Json json = Json::parse(*output, nullptr, false);
  return json.is_discarded() ? Json() : json;
}

void make_page(const Session& session) {
  const ReportOptions& options = session.options();
  std::vector<std::string> arguments = {options.output.string()};
  if (options.compare) arguments.insert(arguments.end(), {"--compare", options.compare->string()});
  const std::optional<std::string> said = read_output(script_words("page.py", arguments));
  if (!said) {
    throw RunError({"report.html could not be made", options.output.string(),
                    "report.json and the CSV files are there; install python3, and see what it says above"});
  }
  if (!said->empty()) session.say(said->substr(0, said->find_last_not_of('\n') + 1));
}

}  // namespace promin::report
