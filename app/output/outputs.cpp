// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/outputs.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>

#include "core/file.h"
#include "core/utf8.h"
#include "image/picture_endings.h"
#include "output/deferred_signals.h"
#include "promin/error.h"
#include "promin/image.h"

namespace promin::app {
namespace fs = std::filesystem;

namespace {

/// Returns a unique path for each file, whether it exists or not.
fs::path resolve(const fs::path& file) {
  std::error_code error;
  const fs::path resolved = fs::weakly_canonical(fs::absolute(follow_links(file), error), error);
  return error ? file : resolved;
}

void check_writable(const fs::path& file) {
  const AtomicFile probe(file);
  const bool is_new = access(file.c_str(), F_OK) != 0;
  if (!std::ofstream(probe.temporary()) || !(is_new || access(file.c_str(), W_OK) == 0)) {
    throw RunError({"file.write", "the output file cannot be written", file.string(),
                    "check the permissions or use another folder"});
  }
}

std::vector<fs::path> all_outputs(std::vector<fs::path> outputs, const std::optional<fs::path>& stats) {
  if (stats) outputs.push_back(*stats);
  return outputs;
}

}  // namespace

std::vector<std::string> names_of(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : files) names.push_back(to_one_line(file.string()));
  return names;
}

bool is_picture_of(const fs::path& file, std::string_view scene) {
  using std::string_literals::operator""s;
  constexpr size_t kHeadBytes = size_t{1} << 20;
  std::string head(kHeadBytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<size_t>(stream.gcount()));
  const auto size = static_cast<uint32_t>(scene.size());
  const std::string key(kSceneKey);
  const auto bytes_of = [](uint32_t number) {
    return std::string{static_cast<char>(number), static_cast<char>(number >> 8), static_cast<char>(number >> 16),
                       static_cast<char>(number >> 24)};
  };
  // An attribute of OpenEXR has a name, a type, a size and a value. An iTXt chunk of PNG has a size, a type, a key, no
  // compression and no language.
  std::string chunk_size = bytes_of(size + static_cast<uint32_t>(key.size()) + 5);
  std::ranges::reverse(chunk_size);
  const std::string in_exr = key + "\0string\0"s + bytes_of(size) + std::string(scene);
  const std::string in_png = chunk_size + "iTXt" + key + "\0\0\0\0\0"s + std::string(scene);
  return head.find(in_exr) != std::string::npos || head.find(in_png) != std::string::npos;
}

void check_overwrites(const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs,
                      const std::optional<fs::path>& stats) {
  const std::vector<fs::path> files = all_outputs(outputs, stats);
  std::set<fs::path> read;
  for (const fs::path& input : inputs) read.insert(resolve(input));
  const auto found = std::ranges::find_if(files, [&](const fs::path& file) { return read.contains(resolve(file)); });
  if (found == files.end()) return;
  throw UsageError({"output.input", "the output would overwrite an input", found->string(), "use another file"});
}

void check_outputs(const std::vector<fs::path>& inputs, const std::vector<fs::path>& outputs,
                   const std::optional<fs::path>& stats) {
  check_overwrites(inputs, outputs, stats);
  const std::vector<fs::path> files = all_outputs(outputs, stats);
  std::set<fs::path> written;
  for (const fs::path& file : files) {
    if (!written.insert(resolve(file)).second) {
      throw UsageError({"output.twice", "the same output file is named twice", file.string(), "use different files"});
    }
  }
  const DeferredSignals while_probing;
  std::set<fs::path> folders;
  for (const fs::path& file : files) {
    check_writable(file);
    folders.insert(resolve(file).parent_path());
  }
  for (const fs::path& folder : folders) clear_leftovers(folder);
}

}  // namespace promin::app
