// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/scene_names.h"

#include <algorithm>

namespace promin::report {
namespace {

namespace fs = std::filesystem;

fs::path normal_path(const fs::path& file) {
  std::error_code error;
  const fs::path normal = fs::weakly_canonical(fs::absolute(file, error), error);
  return error ? file.lexically_normal() : normal;
}

/// The file's name without its ending; of more parts with it and with that many less one of its path's last parts.
std::string last_parts(const fs::path& path, size_t parts) {
  if (parts == 0) return path.stem().string();
  fs::path name;
  fs::path rest = path;
  for (size_t i = 0; i < parts && rest.has_filename(); ++i) {
    name = name.empty() ? rest.filename() : rest.filename() / name;
    rest = rest.parent_path();
  }
  return name.string();
}

}  // namespace

std::vector<std::string> name_scenes(const std::vector<fs::path>& files) {
  std::vector<fs::path> paths;
  // Each round but the last lengthens a name.
  size_t most_rounds = 1;
  for (const fs::path& file : files) {
    paths.push_back(normal_path(file));
    most_rounds += static_cast<size_t>(std::distance(paths.back().begin(), paths.back().end()));
  }
  std::vector<size_t> parts(files.size(), 0);
  std::vector<std::string> names(files.size());
  for (size_t round = 0; round < most_rounds; ++round) {
    for (size_t i = 0; i < files.size(); ++i) names[i] = last_parts(paths[i], parts[i]);
    bool are_unique = true;
    for (size_t i = 0; i < files.size(); ++i) {
      if (std::count(names.begin(), names.end(), names[i]) == 1) continue;
      are_unique = false;
      ++parts[i];
    }
    if (are_unique) break;
  }
  return names;
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  return normal_path(a) == normal_path(b);
}

}  // namespace promin::report
