// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace promin::app {

/// The purpose for which the user chooses a file.
enum class FileUse { kOpen, kSave };

/// The desktop's file dialog, zenity or kdialog, as a separate process. The window does not wait for it.
class FileDialog {
 public:
  FileDialog() = default;
  ~FileDialog() { close(); }
  FileDialog(const FileDialog&) = delete;
  FileDialog& operator=(const FileDialog&) = delete;

  /// Opens the dialog unless one is open. `name` is the initial file name. Returns false if no such program is on PATH.
  bool ask(FileUse use, const std::string& name);
  bool is_open() const { return process_ > 0; }
  /// Closes the dialog if it is open.
  void close();
  FileUse use() const { return use_; }
  /// Returns the file after the user has chosen one. The dialog is then closed. It is also closed if the user cancels.
  std::optional<std::string> take();

 private:
  FileUse use_ = FileUse::kOpen;
  pid_t process_ = 0;
  /// The pipe to which it writes the file's name.
  int pipe_ = -1;
  std::string answer_;
};

/// Returns the command line of zenity or kdialog, by the name of the program.
std::vector<std::string> dialog_command(const std::string& program, FileUse use, const std::string& name);

}  // namespace promin::app
