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
  /// Set in the child only.
  std::map<std::string, std::string> environment;
  /// No file may grow beyond this, by the process's file size limit; see full_disk.cpp for what stands for a full disk.
  std::optional<size_t> max_file_bytes;
  /// The limit of the address space in bytes, as by ulimit -v.
  std::optional<size_t> max_address_bytes;
  /// The standard output; captured if not given.
  std::optional<std::filesystem::path> standard_output;
};

struct ProcessResult {
  /// -1 if a signal ended it.
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
