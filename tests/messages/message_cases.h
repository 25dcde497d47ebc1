// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace promin {

/// A case throws this if its problem causes only a warning, also in strict loading. Such warnings have no code that a
/// test can see, so the case states it.
struct Warned {
  std::vector<std::string> warnings;
};

/// Provokes a problem in the current folder, which is empty before.
struct MessageCase {
  /// The code of the problem.
  std::string_view code;
  std::function<void()> provoke;
  /// True if the words in parentheses come from a library or from the system, so that they differ between versions.
  bool quotes_others = false;
};

/// Returns problems of scene files and of the files that these name. Some are only refused by strict loading; elsewhere
/// their sentences are warnings.
std::vector<MessageCase> cases_of_files();
/// Returns problems of glTF files.
std::vector<MessageCase> cases_of_gltf();
/// Returns problems of scenes in memory, views, pictures, rays and BVH files.
std::vector<MessageCase> cases_of_values();
/// Returns problems of command lines.
std::vector<MessageCase> cases_of_usage();
/// Returns problems of jobs.
std::vector<MessageCase> cases_of_jobs();

/// Writes a file to the current folder.
void write_case(const std::string& name, std::string_view bytes);

}  // namespace promin
