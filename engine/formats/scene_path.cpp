// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/scene_path.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "core/suggest.h"

namespace promin {
namespace fs = std::filesystem;
namespace {

/// Returns whether a name begins with a scheme: "http:", "file:", also "C:". A colon after a slash, or without a name
/// before it, has no special meaning.
bool has_scheme(const std::string& name) {
  const size_t colon = name.find(':');
  return colon != std::string::npos && colon > 0 && std::all_of(name.begin(), name.begin() + colon, [](char c) {
           return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
         });
}

/// Returns the path for a name. Both slashes separate its parts, and dot segments are removed first (RFC 3986, 5.2.4).
fs::path path_of(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return fs::path(name).lexically_normal();
}

/// Returns whether a file is in a folder, after links are resolved.
bool lies_in(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path real_folder = fs::canonical(folder, error);
  if (error) return false;
  const fs::path real_file = fs::weakly_canonical(file, error);
  if (error) return false;
  return std::mismatch(real_folder.begin(), real_folder.end(), real_file.begin(), real_file.end()).first ==
         real_folder.end();
}

std::vector<std::string> list_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  // The system lists a folder in any order, so the names are sorted.
  std::sort(names.begin(), names.end());
  return names;
}

/// Returns the path in a folder that is most similar to a path that does not exist there; empty if none is similar.
fs::path nearest_path(const fs::path& folder, const fs::path& missing) {
  fs::path nearest;
  for (const fs::path& part : missing) {
    std::error_code error;
    if (fs::exists(folder / nearest / part, error)) {
      nearest /= part;
      continue;
    }
    const std::vector<std::string> names = list_names(folder / nearest);
    const std::string_view name =
        nearest_name(part.string(), std::vector<std::string_view>(names.begin(), names.end()));
    if (name.empty()) return {};
    nearest /= name;
  }
  return nearest;
}

std::string suggest_path(const fs::path& folder, const fs::path& missing) {
  const fs::path nearest = nearest_path(folder, missing);
  return nearest.empty() ? "" : ", did you mean " + quote(nearest.string()) + "?";
}

constexpr const char* kStayInside =
    "move the file to the scene's folder, or use --root DIR to allow a folder that contains it";

/// Returns the reason why a name cannot be the path of a scene's file; empty if it can.
std::string find_fault(const std::string& name, const fs::path& path, const fs::path& folder, const fs::path& root) {
  if (has_scheme(name)) return "the path of a file is not relative";
  if (path.is_absolute() && root.empty()) return "the path of a file is absolute";
  const fs::path file = folder / path;
  if (lies_in(folder, file) || (!root.empty() && lies_in(root, file))) return "";
  const bool is_through_link = !path.is_absolute() && *path.begin() != fs::path("..");
  return std::string("the path of a file leads out of the scene's folder") + (root.empty() ? "" : " and the root") +
         (is_through_link ? " through a link" : "");
}

}  // namespace

std::optional<fs::path> find_beside_scene(const std::string& name, const std::string& place, bool must_exist,
                                          LoadReport& report) {
  const auto refuse = [&](ProblemCode code, const std::string& what, const std::string& cure,
                          const std::string& hint = "") {
    report.refuse({.code = code, .what = what, .value = quote(name) + hint, .place = place, .cure = cure});
    return std::nullopt;
  };
  if (name.empty()) return refuse("scene.name.wrong", "a file name is empty", "give the name of a file");
  if (name.find('\0') != std::string::npos)
    return refuse("scene.name.wrong", "a file name contains a zero byte", "give the name of a file");

  const fs::path path = path_of(name);
  const fs::path folder = report.file().has_parent_path() ? report.file().parent_path() : fs::path(".");
  if (const std::string fault = find_fault(name, path, folder, report.root()); !fault.empty()) {
    return refuse("scene.name.outside", fault, kStayInside);
  }

  const fs::path file = folder / path;
  std::error_code error;
  report.add_source(file);
  const fs::file_status status = fs::status(file, error);
  if (fs::is_directory(status)) return refuse("file.folder", "the path of a file is a folder", "give a file");
  if (fs::exists(status) && !fs::is_regular_file(status))
    return refuse("file.kind", "a file is not a regular file", "give a file");
  if (!fs::exists(status)) {
    if (must_exist)
      return refuse("file.missing", "a referenced file does not exist", "put it beside the scene",
                    suggest_path(folder, path));
    return std::nullopt;
  }
  return file;
}

}  // namespace promin
