// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/kernel_folder.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "core/file.h"
#include "core/hash.h"

namespace promin::gpu {
namespace fs = std::filesystem;
namespace {

constexpr const char* kKernelEnding = ".kernel";

/// The first bytes of a file. The key and the binary follow.
struct KernelHead {
  std::array<char, 8> magic{'p', 'r', 'o', 'm', 'i', 'n', 'K', '1'};
  uint64_t checksum = 0;
  uint64_t key_bytes = 0;
  uint64_t binary_bytes = 0;
};
static_assert(sizeof(KernelHead) == 32);

uint64_t checksum_of(std::span<const std::byte> key, std::span<const std::byte> binary) {
  Hash64 hash;
  for (const std::span<const std::byte> part : {key, binary}) {
    hash.add(part.size());
    hash.add(part);
  }
  return hash.value();
}

std::optional<fs::path> absolute_path_of(const char* variable) {
  const char* const value = std::getenv(variable);
  const fs::path path = value == nullptr ? "" : value;
  return path.is_absolute() ? std::optional(path) : std::nullopt;
}

}  // namespace

KernelFolder::KernelFolder(fs::path folder, uint64_t most_bytes)
    : folder_(std::move(folder)), most_bytes_(most_bytes) {}

std::optional<fs::path> KernelFolder::usual() {
  const fs::path own = fs::path("promin") / "kernels";
  if (const auto cache = absolute_path_of("XDG_CACHE_HOME")) return *cache / own;
  if (const auto home = absolute_path_of("HOME")) return *home / ".cache" / own;
  return {};
}

fs::path KernelFolder::file_of(std::span<const uint32_t> key) const {
  Hash64 hash;
  hash.add(std::as_bytes(key));
  std::array<char, 17> digits{};
  std::snprintf(digits.data(), digits.size(), "%016llx", static_cast<unsigned long long>(hash.value()));
  return folder_ / (digits.data() + std::string(kKernelEnding));
}

std::vector<std::byte> KernelFolder::find(std::span<const uint32_t> key) const try {
  const fs::path file = file_of(key);
  // Reading a pipe would wait forever.
  if (!fs::is_regular_file(file)) return {};
  const std::vector<std::byte> bytes = read_file(file, most_bytes_);
  KernelHead head;
  if (bytes.size() < sizeof head) return {};
  std::memcpy(&head, bytes.data(), sizeof head);
  const std::span<const std::byte> rest = std::span(bytes).subspan(sizeof head);
  // Two keys may have the same name.
  const std::span<const std::byte> key_bytes = std::as_bytes(key);
  if (head.magic != KernelHead().magic || head.key_bytes != key_bytes.size() || rest.size() < key_bytes.size() ||
      !std::ranges::equal(rest.first(key_bytes.size()), key_bytes)) {
    return {};
  }
  const std::span<const std::byte> binary = rest.subspan(key_bytes.size());
  if (head.binary_bytes != binary.size() || head.checksum != checksum_of(key_bytes, binary)) return {};
  std::error_code error;
  fs::last_write_time(file, fs::file_time_type::clock::now(), error);
  return {binary.begin(), binary.end()};
} catch (const std::exception&) {
  return {};
}

void KernelFolder::store(std::span<const uint32_t> key, std::span<const std::byte> binary) const {
  std::string problem = try_to_store(key, binary);
  const std::lock_guard lock(mutex_);
  problem_ = std::move(problem);
}

std::string KernelFolder::try_to_store(std::span<const uint32_t> key, std::span<const std::byte> binary) const try {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return folder_.string() + " cannot be created (" + error.message() + ")";
  KernelHead head;
  head.key_bytes = key.size_bytes();
  head.binary_bytes = binary.size();
  head.checksum = checksum_of(std::as_bytes(key), binary);
  write_file(file_of(key), {std::as_bytes(std::span(&head, 1)), std::as_bytes(key), binary});
  remove_least_used();
  return {};
} catch (const std::exception& error) {
  return error.what();
}

void KernelFolder::remove_least_used() const {
  struct Entry {
    fs::file_time_type used;
    uint64_t bytes;
    fs::path file;
  };
  clear_leftovers(folder_);
  std::vector<Entry> entries;
  uint64_t total = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
    // The stem of a temporary file, which another process is writing, has an extension itself.
    const fs::path name = entry.path().filename();
    if (name.extension() != kKernelEnding || name.stem().has_extension()) continue;
    // Another process may remove the file meanwhile.
    std::error_code error;
    if (!entry.is_regular_file(error)) continue;
    const fs::file_time_type used = entry.last_write_time(error);
    const uint64_t bytes = error ? 0 : entry.file_size(error);
    if (error) continue;
    entries.push_back({used, bytes, entry.path()});
    total += bytes;
  }
  if (total <= most_bytes_) return;
  std::ranges::sort(entries, {}, &Entry::used);
  for (const Entry& entry : entries) {
    if (total <= most_bytes_) break;
    std::error_code error;
    fs::remove(entry.file, error);
    total -= entry.bytes;
  }
}

std::string KernelFolder::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

}  // namespace promin::gpu
