// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/file.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>

#include "core/parse_number.h"
#include "core/stand_in.h"
#include "promin/error.h"

namespace promin {
namespace fs = std::filesystem;

std::string lower_case_ending(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

void refuse_lost_folder(const fs::path& file) {
  std::error_code error;
  if (file.is_absolute()) return;
  static_cast<void>(fs::current_path(error));
  if (error != std::errc::no_such_file_or_directory) return;
  throw RunError({"folder.lost", "the current folder no longer exists", file.string(), "change to an existing folder"});
}

fs::file_status find_input(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::none) {
    throw InputError({"file.access", "the file cannot be accessed (" + error.message() + ")", file.string(),
                      "check its permissions"});
  }
  if (!fs::exists(status)) refuse_lost_folder(file);
  if (!fs::exists(status))
    throw InputError({"file.missing", "the file does not exist", file.string(), "check the path"});
  return status;
}

std::optional<FileStamp> stamp_of(const fs::path& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return std::nullopt;
  constexpr int64_t kNsPerSecond = 1'000'000'000;
  return FileStamp{status.st_mtim.tv_sec * kNsPerSecond + status.st_mtim.tv_nsec, static_cast<uint64_t>(status.st_size),
                   status.st_ino};
}

std::vector<std::byte> read_file(const fs::path& file, uint64_t most_bytes) {
  const fs::file_status status = find_input(file);
  if (fs::is_directory(status))
    throw InputError({"file.folder", "this is a folder, not a file", file.string(), "give a file in it"});
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  if (!stream) throw InputError({"file.open", "the file cannot be opened", file.string(), "check its permissions"});
  const std::streamoff size = stream.tellg();
  if (size < 0) throw InputError({"file.kind", "the file cannot be read", file.string(), "use a regular file"});
  if (size == 0) throw InputError({"file.empty", "the file is empty", file.string(), "export it again"});
  std::vector<std::byte> bytes(std::min(static_cast<uint64_t>(size), most_bytes));
  stream.seekg(0);
  if (!stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) {
    throw InputError({"file.read", "the file cannot be read to its end", file.string(), "check the disk"});
  }
  if (const StandIn* stand_in = find_stand_in({reinterpret_cast<const char*>(bytes.data()), bytes.size()})) {
    throw InputError({"file.placeholder", std::string("the file is ") + stand_in->what, file.string(), stand_in->cure});
  }
  return bytes;
}

std::string host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "host";
  return name.data();
}

namespace {

/// Prefix of the name under which AtomicFile::commit_together keeps an old file.
constexpr const char* kOldMark = "old-";
constexpr mode_t kModeBits = 07777;

/// The temporary files that this process is writing. Another of its threads may write the same file, and an earlier
/// process with the same id may have left files, which must be distinguished from these.
class LiveFiles {
 public:
  /// Adds a file. Returns false if a file of this name is already in the list.
  bool add(const fs::path& file) {
    const std::lock_guard lock(mutex_);
    return files_.insert(spell(file)).second;
  }
  void remove(const fs::path& file) {
    const std::lock_guard lock(mutex_);
    files_.erase(spell(file));
  }
  bool has(const fs::path& file) {
    const std::lock_guard lock(mutex_);
    return files_.contains(spell(file));
  }

 private:
  static fs::path spell(const fs::path& file) {
    std::error_code error;
    const fs::path whole = fs::absolute(file, error);
    return (error ? file : whole).lexically_normal();
  }

  std::mutex mutex_;
  std::set<fs::path> files_;
};

LiveFiles& live_files() {
  static LiveFiles files;
  return files;
}

}  // namespace

fs::path follow_links(const fs::path& file) {
  std::error_code error;
  const fs::path resolved = fs::canonical(file, error);
  if (!error) return resolved;
  // The largest number of links that the C library follows.
  constexpr int kMostLinks = 40;
  fs::path target = file;
  for (int link = 0; fs::is_symlink(target, error); ++link) {
    if (link == kMostLinks) return file;
    // If the link's target is an absolute path, it replaces the folder.
    target = target.parent_path() / fs::read_symlink(target, error);
  }
  return target;
}

namespace {

/// Returns the first bytes of a text, without an incomplete character at the end.
std::string cut_utf8(std::string text, size_t most_bytes) {
  const auto continues = [&](size_t at) { return (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80; };
  if (text.size() <= most_bytes) return text;
  while (most_bytes > 0 && continues(most_bytes)) --most_bytes;
  text.resize(most_bytes);
  return text;
}

/// Returns a name in the folder that has the form of AtomicFile::temporary(). The name is short enough for the file
/// system, although the target's own name may have the largest allowed length.
fs::path name_temporary(const fs::path& folder, const fs::path& target, int writer) {
  constexpr size_t kUsualMost = 255;
  constexpr size_t kLongestEnding = 16;
  // The name contains the host, because several machines may see the folder.
  std::string mark = ".tmp" + std::to_string(getpid()) + "-" + host_name();
  if (writer > 1) mark.insert(0, '.' + std::to_string(writer));
  mark += target.extension().string().substr(0, kLongestEnding);
  const long told = pathconf(folder.c_str(), _PC_NAME_MAX);
  const size_t most = told > 0 ? static_cast<size_t>(told) : kUsualMost;
  // The rest of the name leaves space for the prefix of commit_together.
  const size_t taken = mark.size() + std::string_view(kOldMark).size();
  return folder / (cut_utf8(target.stem().string(), most > taken ? most - taken : 0) + mark);
}

}  // namespace

AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)) {
  std::error_code error;
  // Without this, rename() would replace a symbolic link and not the file that it points to.
  if (fs::is_symlink(target_, error)) target_ = follow_links(target_);
  refuse_lost_folder(target_);
  const fs::path folder = target_.has_parent_path() ? target_.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, error)) {
    throw RunError({"output.folder.missing", "the folder of the output file does not exist", target_.string(),
                    "create " + folder.string()});
  }
  if (fs::is_directory(target_, error)) {
    throw RunError({"output.kind", "the output file is a folder", target_.string(), "give a file"});
  }
  // With root's rights, rename() would even replace a device by a file.
  if (fs::exists(target_, error) && !fs::is_regular_file(target_, error)) {
    throw RunError({"output.kind", "the output file is a device or a pipe", target_.string(), "give a file"});
  }
  for (int writer = 1; temporary_.empty() || !live_files().add(temporary_); ++writer) {
    temporary_ = name_temporary(folder, target_, writer);
  }
  begin_with_mode();
}

void AtomicFile::begin_with_mode() {
  struct stat old {};
  if (stat(target_.c_str(), &old) != 0) return;
  mode_ = old.st_mode & kModeBits;
  const int descriptor = open(temporary_.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor < 0) return;
  fchmod(descriptor, *mode_ | S_IWUSR);
  close(descriptor);
}

AtomicFile::~AtomicFile() {
  live_files().remove(temporary_);
  if (committed_) return;
  std::error_code error;
  fs::remove(temporary_, error);
}

void AtomicFile::fail() const {
  throw RunError({"file.write", std::string("the output file cannot be written (") + std::strerror(errno) + ")",
                  target_.string(), "check the disk and permissions"});
}

void AtomicFile::flush() const {
  // Without this, the renamed file may reach the disk before its data does, and a crash would leave an empty file.
  const int descriptor = open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  // fchmod() has no effect on a file system without modes.
  if (descriptor >= 0 && mode_) fchmod(descriptor, *mode_);
  const bool is_flushed = descriptor >= 0 && fsync(descriptor) == 0;
  if (descriptor >= 0) close(descriptor);
  if (!is_flushed) fail();
}

void AtomicFile::rename_to_target() {
  if (rename(temporary_.c_str(), target_.c_str()) != 0) fail();
  committed_ = true;
}

void AtomicFile::commit() {
  flush();
  rename_to_target();
}

namespace {

/// Creates another name for an old file, or a copy if the file system does not support hard links. Returns false if
/// there is no old file. Throws RunError.
bool keep_old(const fs::path& file, const fs::path& name) {
  std::error_code error;
  if (!fs::exists(file, error)) return false;
  fs::create_hard_link(file, name, error);
  if (!error) return true;
  fs::copy_file(file, name, fs::copy_options::overwrite_existing, error);
  if (!error) return true;
  throw RunError({"file.keep", "the old file cannot be kept until the new ones are complete (" + error.message() + ")",
                  file.string(), "move it elsewhere, or check the disk and permissions"});
}

}  // namespace

void AtomicFile::commit_together(std::span<AtomicFile* const> files) {
  for (const AtomicFile* file : files) file->flush();
  // A second name for each old file, which renaming does not affect; empty if there is no old file. The name has the
  // form of a temporary file, so that clear_leftovers() removes it if the process is killed.
  std::vector<fs::path> old_files(files.size());
  const auto name_old = [&](size_t i) {
    fs::path name = files[i]->temporary_.parent_path() / kOldMark;
    name += files[i]->temporary_.filename();
    if (keep_old(files[i]->target_, name)) old_files[i] = name;
  };
  const auto remove_names = [&] {
    std::error_code error;
    for (const fs::path& old_file : old_files) {
      if (!old_file.empty()) fs::remove(old_file, error);
    }
  };
  try {
    // While files are renamed, all files except the first are absent. If the process is killed, a new file is therefore
    // never beside an old one.
    for (size_t i = files.size(); i-- > 0;) {
      name_old(i);
      if (i > 0 && !old_files[i].empty() && unlink(files[i]->target_.c_str()) != 0) files[i]->fail();
    }
    for (AtomicFile* file : files) file->rename_to_target();
  } catch (...) {
    for (size_t i = 0; i < files.size(); ++i) {
      std::error_code error;
      if (!old_files[i].empty()) {
        fs::rename(old_files[i], files[i]->target_, error);
      } else if (files[i]->committed_) {
        fs::remove(files[i]->target_, error);
      }
    }
    remove_names();
    throw;
  }
  remove_names();
}

void clear_leftovers(const fs::path& folder) {
  constexpr std::string_view kMark = ".tmp";
  std::string owner = "-";
  owner += host_name();
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().stem().string();
    const size_t mark = name.rfind(kMark);
    if (mark == std::string::npos) continue;
    std::string_view rest = std::string_view(name).substr(mark + kMark.size());
    const pid_t pid = take_number<pid_t>(rest).value_or(0);
    if (pid <= 0 || rest != owner) continue;
    const bool is_alive = pid == getpid() ? live_files().has(entry.path()) : kill(pid, 0) == 0 || errno != ESRCH;
    if (!is_alive) fs::remove(entry.path(), error);
  }
}

int write_at(int descriptor, uint64_t place, std::span<const std::byte> bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return written < 0 ? errno : ENOSPC;
    place += static_cast<uint64_t>(written);
    bytes = bytes.subspan(static_cast<size_t>(written));
  }
  return 0;
}

void write_file(const fs::path& file, const std::vector<std::span<const std::byte>>& parts) {
  AtomicFile output(file);
  std::ofstream stream(output.temporary(), std::ios::binary);
  for (const std::span<const std::byte> part : parts) {
    stream.write(reinterpret_cast<const char*>(part.data()), static_cast<std::streamsize>(part.size()));
  }
  stream.close();
  if (!stream) {
    throw RunError({"file.write", std::string("the output file cannot be written (") + std::strerror(errno) + ")",
                    file.string(), "check the disk and permissions"});
  }
  output.commit();
}

void write_text_file(const fs::path& file, std::string_view text) {
  write_file(file, {std::as_bytes(std::span(text))});
}

}  // namespace promin
