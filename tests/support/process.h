// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace promin {

struct ProcessOptions {
  std::filesystem::path folder;
  /// Variables that are set only in the child.
  std::map<std::string, std::string> environment;
  /// No file may grow beyond this size, by the process's file size limit; see full_disk.cpp for the simulation of a
  /// full disk.
  std::optional<size_t> max_file_bytes;
  /// The limit of the address space in bytes, as set by ulimit -v.
  std::optional<size_t> max_address_bytes;
  /// The file for the standard output. Without it the output is captured.
  std::optional<std::filesystem::path> standard_output;
};

struct ProcessResult {
  /// The exit code; -1 if a signal ended the process.
  int exit_code = -1;
  int signal = 0;
  std::string out;
  std::string err;
};

/// A program that runs in the background.
class Process {
 public:
  Process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
          const ProcessOptions& options);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const;
  /// Returns what the process has written to its standard error so far.
  std::string err() const;
  /// Waits until the process ends.
  ProcessResult wait();

 private:
  pid_t child_ = -1;
  int out_ = -1;
  int err_ = -1;
};

}  // namespace promin
