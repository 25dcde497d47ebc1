// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "process.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <system_error>

namespace promin {
namespace {

/// Makes a file in memory: unlike a pipe it never fills up, and it is not a terminal.
int make_capture() {
  const int descriptor = memfd_create("capture", MFD_CLOEXEC);
  if (descriptor < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
  return descriptor;
}

std::string read_capture(int descriptor) {
  std::string text(static_cast<size_t>(lseek(descriptor, 0, SEEK_END)), '\0');
  if (pread(descriptor, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) return "(cannot read)";
  return text;
}

void set_limit(__rlimit_resource resource, size_t most) {
  rlimit limit{};
  getrlimit(resource, &limit);
  limit.rlim_cur = most;
  setrlimit(resource, &limit);
}

[[noreturn]] void become(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                         const ProcessOptions& options, int out, int err) {
  if (options.standard_output) out = open(options.standard_output->c_str(), O_WRONLY);
  dup2(out, STDOUT_FILENO);
  dup2(err, STDERR_FILENO);
  if (!options.folder.empty() && chdir(options.folder.c_str()) != 0) _exit(126);
  for (const auto& [name, value] : options.environment) setenv(name.c_str(), value.c_str(), 1);
  if (options.max_file_bytes) {
    // The signal has its default action, as in a shell, even if this process ignores it.
    std::signal(SIGXFSZ, SIG_DFL);
    set_limit(RLIMIT_FSIZE, *options.max_file_bytes);
  }
  if (options.max_address_bytes) set_limit(RLIMIT_AS, *options.max_address_bytes);
  std::vector<char*> words = {const_cast<char*>(program.c_str())};
  for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  execv(program.c_str(), words.data());
  _exit(127);
}

}  // namespace

Process::Process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 const ProcessOptions& options)
    : out_(make_capture()), err_(make_capture()) {
  child_ = fork();
  if (child_ == 0) become(program, arguments, options, out_, err_);
}

Process::~Process() {
  if (child_ > 0) {
    kill(child_, SIGKILL);
    waitpid(child_, nullptr, 0);
  }
  close(out_);
  close(err_);
}

void Process::send(int signal) const {
  kill(child_, signal);
}

std::string Process::err() const {
  return read_capture(err_);
}

ProcessResult Process::wait() {
  int status = 0;
  waitpid(child_, &status, 0);
  child_ = -1;
  ProcessResult result;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  result.out = read_capture(out_);
  result.err = read_capture(err_);
  return result;
}

}  // namespace promin
