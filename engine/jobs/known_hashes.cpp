// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "jobs/known_hashes.h"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/json_text.h"
#include "promin/error.h"

namespace promin::jobs {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

}  // namespace

KnownHashes::KnownHashes(const fs::path& folder) : file_(folder / "hashes.json") {
  std::ifstream stream(file_);
  const Json json = read_ordered_json_or_discard(std::string(std::istreambuf_iterator<char>(stream), {}));
  if (!json.is_object()) return;
  try {
    for (const auto& [path, entry] : json.items()) {
      known_[path] = {{entry.at("written_ns"), entry.at("size_bytes"), entry.at("inode")}, entry.at("sha256")};
    }
  } catch (const nlohmann::json::exception&) {
    known_.clear();
  }
}

InputFile KnownHashes::describe(const fs::path& file) {
  const std::optional<FileStamp> stamp = stamp_of(file);
  const std::string path = fs::absolute(file).lexically_normal().string();
  const auto found = known_.find(path);
  if (stamp && found != known_.end() && found->second.stamp == *stamp) {
    return {file.filename().string(), stamp->size_bytes, found->second.sha256};
  }
  InputFile described = describe_input(file);
  if (!stamp || stamp_of(file) != stamp) {
    throw InputError({"file.changed", "the file changed while it was read", file.string(), "try again"});
  }
  known_[path] = {*stamp, described.sha256};
  has_more_ = true;
  return described;
}

void KnownHashes::save() {
  if (!has_more_) return;
  Json json = Json::object();
  for (const auto& [path, entry] : known_) {
    json[path] = {{"written_ns", entry.stamp.written_ns},
                  {"size_bytes", entry.stamp.size_bytes},
                  {"inode", entry.stamp.inode},
                  {"sha256", entry.sha256}};
  }
  try {
    write_text_file(file_, json_text(json, 1) + "\n");
  } catch (const RunError&) {
    // Later processes then read the file and hash it themselves.
    return;
  }
  has_more_ = false;
}

}  // namespace promin::jobs
