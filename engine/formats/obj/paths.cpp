// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/obj/paths.h"

#include "formats/scene_path.h"
#include "formats/text_lines.h"

namespace promin {
namespace {

/// Returns the result of find_beside_scene() for a file; nullopt if it refuses the name.
std::optional<std::string> try_name(std::string_view name, const std::string& folder, LoadReport& report) {
  LoadReport attempt = report.make_attempt();
  // An absolute name must not become a relative one below the folder.
  const bool is_absolute = name.starts_with('/') || name.starts_with('\\');
  std::string whole = (is_absolute || name.empty() ? "" : folder) + std::string(name);
  const bool is_there = find_beside_scene(whole, "", false, attempt).has_value();
  for (const SourceFile& source : attempt.sources()) report.add_source(source.file);
  return is_there ? std::optional(std::move(whole)) : std::nullopt;
}

}  // namespace

std::string_view without_comment(std::string_view name) {
  for (size_t at = name.find('#'); at != std::string_view::npos; at = name.find('#', at + 1)) {
    if (at == 0 || name[at - 1] == ' ' || name[at - 1] == '\t') return trim(name.substr(0, at));
  }
  return name;
}

std::optional<std::string> find_named_file(const std::string& name, const std::string& folder, LoadReport& report) {
  if (auto found = try_name(name, folder, report)) return found;
  const std::string_view shorter = without_comment(name);
  return shorter == name ? std::nullopt : try_name(shorter, folder, report);
}

std::optional<std::string> find_by_last_part(const std::string& name, const std::string& folder, LoadReport& report) {
  const std::string last = name.substr(name.find_last_of("/\\:") + 1);
  std::optional<std::string> found = find_named_file(last, folder, report);
  if (!found) found = find_named_file(last, "", report);
  if (found)
    report.warn(
        "promin reads files that are named in other folders from the scene's folder, which has files with the same "
        "names");
  return found;
}

}  // namespace promin
