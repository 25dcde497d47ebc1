// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/ffmpeg.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/utf8.h"
#include "promin/error.h"

namespace promin::work {
namespace {

constexpr const char* kProgram = "ffmpeg";

bool is_installed() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/bin:/usr/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::filesystem::path file = std::filesystem::path(folder.empty() ? "." : folder) / kProgram;
    std::error_code none;
    if (access(file.c_str(), X_OK) == 0 && std::filesystem::is_regular_file(file, none)) return true;
  }
  return false;
}

[[noreturn]] void refuse_without_ffmpeg(const std::filesystem::path& film) {
  throw RunError({"film.ffmpeg.missing", "promin writes films with the program ffmpeg, which is not installed",
                  film.string(),
                  "install ffmpeg, or write the frames as pictures, such as -o " + film.stem().string() + ".####.png"});
}

[[noreturn]] void refuse_start(const std::filesystem::path& film, int error) {
  throw RunError({"film.encode",
                  fmt::format("the program ffmpeg cannot be started ({})", std::generic_category().message(error)),
                  film.string(), "check the limits on processes and open files"});
}

/// Returns the last line of a file that is not empty.
std::string last_line(int descriptor) {
  constexpr off_t kMost = 4096;
  const off_t end = lseek(descriptor, 0, SEEK_END);
  std::array<char, kMost> tail{};
  const ssize_t count = pread(descriptor, tail.data(), tail.size(), end > kMost ? end - kMost : 0);
  std::istringstream lines(std::string(tail.data(), count > 0 ? static_cast<size_t>(count) : 0));
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    if (line.find_first_not_of(" \r\t") != std::string::npos) last = line;
  }
  return to_one_line(last);
}

/// Returns an open file without a name.
int open_scratch() {
  std::FILE* file = std::tmpfile();
  if (file == nullptr) return -1;
  const int descriptor = fcntl(fileno(file), F_DUPFD_CLOEXEC, 3);
  std::fclose(file);
  return descriptor;
}

/// The attributes of a new process: it has a process group of its own and the usual reactions to signals.
class SpawnSetup {
 public:
  SpawnSetup(int input, int messages) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, messages, STDERR_FILENO);
    posix_spawnattr_init(&attributes_);
    sigset_t usual;
    sigemptyset(&usual);
    posix_spawnattr_setsigmask(&attributes_, &usual);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) sigaddset(&usual, signal);
    posix_spawnattr_setsigdefault(&attributes_, &usual);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
  }
  ~SpawnSetup() {
    posix_spawnattr_destroy(&attributes_);
    posix_spawn_file_actions_destroy(&actions_);
  }
  SpawnSetup(const SpawnSetup&) = delete;
  SpawnSetup& operator=(const SpawnSetup&) = delete;

  int start(const std::vector<std::string>& arguments, pid_t& process) const {
    std::string name = kProgram;
    std::vector<std::string> copies = arguments;
    std::vector<char*> words = {name.data()};
    for (std::string& copy : copies) words.push_back(copy.data());
    words.push_back(nullptr);
    return posix_spawnp(&process, kProgram, &actions_, &attributes_, words.data(), environ);
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

}  // namespace

void check_ffmpeg(const std::filesystem::path& film) {
  if (!is_installed()) refuse_without_ffmpeg(film);
}

Ffmpeg::Ffmpeg(std::filesystem::path film, const std::vector<std::string>& arguments) : film_(std::move(film)) {
  check_ffmpeg(film_);
  // A write to a closed socket returns an error. A write to a closed pipe would also send a signal.
  int ends[2] = {-1, -1};
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) refuse_start(film_, errno);
  input_ = ends[0];
  messages_ = open_scratch();
  const int error = messages_ < 0 ? errno : SpawnSetup(ends[1], messages_).start(arguments, process_);
  ::close(ends[1]);
  if (error == 0) return;
  process_ = -1;
  end();
  if (error == ENOENT) refuse_without_ffmpeg(film_);
  refuse_start(film_, error);
}

Ffmpeg::~Ffmpeg() {
  if (process_ > 0) kill(process_, SIGKILL);
  end();
}

int Ffmpeg::wait() {
  int status = 0;
  if (process_ <= 0) return status;
  const pid_t process = std::exchange(process_, -1);
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

void Ffmpeg::end() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
  wait();
  if (messages_ >= 0) ::close(std::exchange(messages_, -1));
}

void Ffmpeg::fail() {
  const std::string why = last_line(messages_);
  end();
  throw RunError({"film.encode",
                  fmt::format("ffmpeg cannot write the film ({})", why.empty() ? "it gives no reason" : why),
                  film_.string(), "try another format, such as .mp4, .webm or .gif, or write the frames as pictures"});
}

void Ffmpeg::write(std::span<const uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count >= 0) {
      bytes = bytes.subspan(static_cast<size_t>(count));
    } else if (errno != EINTR) {
      // ffmpeg has ended. Its messages are complete when it is waited for.
      wait();
      fail();
    }
  }
}

void Ffmpeg::finish() {
  ::close(std::exchange(input_, -1));
  const int status = wait();
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail();
  end();
}

}  // namespace promin::work
