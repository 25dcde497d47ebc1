// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace promin::work {

/// Throws RunError if the program ffmpeg is not in a folder of PATH. `film` is the file that needs it, for the message.
void check_ffmpeg(const std::filesystem::path& film);

/// A process of the program ffmpeg that encodes a film. It reads frames from its standard input and writes the film to
/// a temporary file, which the caller renames. A signal from the terminal does not reach the process.
class Ffmpeg {
 public:
  /// Starts ffmpeg with these arguments. `film` is the final name of the film, for messages. Throws RunError.
  Ffmpeg(std::filesystem::path film, const std::vector<std::string>& arguments);
  /// Ends the process if finish() was not called.
  ~Ffmpeg();
  Ffmpeg(const Ffmpeg&) = delete;
  Ffmpeg& operator=(const Ffmpeg&) = delete;

  /// Waits until ffmpeg has accepted the bytes. Throws RunError with ffmpeg's last line if it has ended.
  void write(std::span<const uint8_t> bytes);
  /// Waits until the film is complete. Throws RunError with ffmpeg's last line.
  void finish();

 private:
  /// Waits until the process has ended, unless it was waited for before. Returns its status.
  int wait();
  void end();
  [[noreturn]] void fail();

  std::filesystem::path film_;
  pid_t process_ = -1;
  /// The socket that is connected to ffmpeg's standard input.
  int input_ = -1;
  /// A file without a name for ffmpeg's messages.
  int messages_ = -1;
};

}  // namespace promin::work
