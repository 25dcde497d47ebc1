// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace promin::app {

/// What a file is chosen for.
enum class FileUse { kOpen, kSave };

/// The desktop's dialog that asks for a file, zenity or kdialog, as a process of its own. Nothing waits for it.
class FileDialog {
 public:
  FileDialog() = default;
  ~FileDialog() { close(); }
  FileDialog(const FileDialog&) = delete;
  FileDialog& operator=(const FileDialog&) = delete;

  /// Opens the dialog unless one is open. `name` is what it begins with. False where there is no such program on PATH.
  bool ask(FileUse use, const std::string& name);
  bool is_open() const { return process_ > 0; }
  /// Closes a dialog that is open.
  void close();
  FileUse use() const { return use_; }
  /// The file, once the user has chosen one. The dialog is closed then, and where the user wants none.
  std::optional<std::string> take();

 private:
  FileUse use_ = FileUse::kOpen;
  pid_t process_ = 0;
  /// Where it writes the file's name.
  int pipe_ = -1;
  std::string answer_;
};

/// The command line of zenity or kdialog, by the name of the program.
std::vector<std::string> dialog_command(const std::string& program, FileUse use, const std::string& name);

}  // namespace promin::app
