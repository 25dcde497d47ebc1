// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/scene/file_dialog.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>

namespace promin::app {
namespace {

constexpr const char* kScenes = "*.gltf *.glb *.obj *.ply *.stl *.nff";

/// Starts a program that writes to a pipe. Returns 0 if the program does not exist.
pid_t start(const std::vector<std::string>& command, int output) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  pid_t process = 0;
  const int error = posix_spawnp(&process, words.front(), &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  return error == 0 ? process : 0;
}

}  // namespace

std::vector<std::string> dialog_command(const std::string& program, FileUse use, const std::string& name) {
  const bool is_save = use == FileUse::kSave;
  if (program == "kdialog") {
    if (is_save) return {program, "--getsavefilename", name};
    return {program, "--getopenfilename", name, std::string("Scenes (") + kScenes + ")"};
  }
  std::vector<std::string> command = {program, "--file-selection", "--filename=" + name};
  if (is_save) {
    command.insert(command.end(), {"--title=Save the picture", "--save", "--confirm-overwrite"});
  } else {
    command.insert(command.end(), {"--title=Open a scene", std::string("--file-filter=Scenes | ") + kScenes,
                                   "--file-filter=All files | *"});
  }
  return command;
}

void FileDialog::close() {
  if (!is_open()) return;
  // SIGKILL is used, because the process may have inherited blocked signals.
  kill(process_, SIGKILL);
  ::close(pipe_);
  waitpid(process_, nullptr, 0);
  process_ = 0;
}

bool FileDialog::ask(FileUse use, const std::string& name) {
  if (is_open()) return true;
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) return false;
  for (const char* program : {"zenity", "kdialog"}) {
    process_ = start(dialog_command(program, use, name), ends[1]);
    if (is_open()) break;
  }
  ::close(ends[1]);
  if (!is_open()) ::close(ends[0]);
  use_ = use;
  pipe_ = ends[0];
  answer_.clear();
  return is_open();
}

std::optional<std::string> FileDialog::take() {
  if (!is_open()) return std::nullopt;
  std::array<char, 4096> bytes{};
  ssize_t count = 0;
  while ((count = read(pipe_, bytes.data(), bytes.size())) > 0)
    answer_.append(bytes.data(), static_cast<size_t>(count));
  int status = 0;
  // The program has written everything before it ends.
  if (count < 0 || waitpid(process_, &status, WNOHANG) != process_) return std::nullopt;
  ::close(pipe_);
  process_ = 0;
  while (!answer_.empty() && answer_.back() == '\n') answer_.pop_back();
  const bool is_chosen = WIFEXITED(status) && WEXITSTATUS(status) == 0 && !answer_.empty();
  return is_chosen ? std::optional(answer_) : std::nullopt;
}

}  // namespace promin::app
