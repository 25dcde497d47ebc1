// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/find_file.h"

#include "formats/scene_path.h"
#include "formats/text_lines.h"

namespace promin {
namespace {

std::string last_part(const std::string& name) {
  return name.substr(name.find_last_of("/\\") + 1);
}

/// As find_beside_scene, but what is wrong is no problem of the scene's.
std::optional<std::filesystem::path> try_file(const std::string& name, LoadReport& report) {
  LoadReport attempt(report.file(), false, report.root());
  const std::optional<std::filesystem::path> file = find_beside_scene(name, "", true, attempt);
  for (const SourceFile& source : attempt.sources()) report.add_source(source.file);
  return file;
}

}  // namespace

std::string without_comment(const std::string& name) {
  const size_t comment = name.find(" #");
  return std::string(trim(std::string_view(name).substr(0, comment)));
}

std::optional<std::filesystem::path> find_named_file(const std::string& folder, const std::string& name,
                                                     LoadReport& report) {
  const std::string bare = without_comment(name);
  for (const std::string& tried : {name, bare, last_part(name), last_part(bare)}) {
    if (tried.empty()) continue;
    if (const auto file = try_file(folder + tried, report)) return file;
  }
  // Once more, for what is wrong.
  return find_beside_scene(folder + name, "", true, report);
}

}  // namespace promin
