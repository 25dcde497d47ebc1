// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/scene_path.h"

#include <algorithm>
#include <cctype>

namespace promin {
namespace fs = std::filesystem;
namespace {

/// "http:", "file:", also "C:". A colon after a slash or without a name before it is an ordinary character.
bool has_scheme(const std::string& name) {
  const size_t colon = name.find(':');
  return colon != std::string::npos && colon > 0 && std::all_of(name.begin(), name.begin() + colon, [](char c) {
           return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '+' || c == '-' || c == '.';
         });
}

bool leaves_folder(const fs::path& folder, const fs::path& file) {
  std::error_code error;
  const fs::path real_folder = fs::weakly_canonical(folder, error);
  if (error) return true;
  const fs::path real_file = fs::weakly_canonical(file, error);
  if (error) return true;
  return std::mismatch(real_folder.begin(), real_folder.end(), real_file.begin(), real_file.end()).first !=
         real_folder.end();
}

}  // namespace

std::optional<fs::path> find_beside_scene(const std::string& name, const std::string& place, bool must_exist,
                                          LoadReport& report) {
  const auto refuse = [&](const std::string& what, const std::string& cure) {
    report.refuse(what, place, cure);
    return std::nullopt;
  };
  const std::string quoted = quote(name);
  const std::string keep_inside = "keep the file in the scene's folder and name it relative to the scene";
  if (name.empty()) return refuse("a file name is empty", "name a file");
  if (name.find('\0') != std::string::npos) return refuse("a file name holds a zero byte", "name a file");
  if (has_scheme(name)) return refuse(quoted + " is no relative path", keep_inside);
  if (name.front() == '/' || name.front() == '\\') return refuse(quoted + " is an absolute path", keep_inside);

  std::string slashed = name;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  const fs::path relative(slashed);
  if (std::find(relative.begin(), relative.end(), fs::path("..")) != relative.end()) {
    return refuse(quoted + " leaves the scene's folder", keep_inside);
  }

  const fs::path folder = report.file().has_parent_path() ? report.file().parent_path() : fs::path(".");
  const fs::path file = folder / relative;
  if (leaves_folder(folder, file)) return refuse(quoted + " leaves the scene's folder through a link", keep_inside);
  std::error_code error;
  report.add_source(file);
  const fs::file_status status = fs::status(file, error);
  if (fs::is_directory(status)) return refuse(quoted + " is a folder", "name a file");
  if (fs::exists(status) && !fs::is_regular_file(status)) return refuse(quoted + " is no regular file", "name a file");
  if (!fs::exists(status)) {
    if (must_exist) return refuse(quoted + " does not exist", "put the file beside the scene");
    return std::nullopt;
  }
  return file;
}

}  // namespace promin
