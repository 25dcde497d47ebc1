// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace promin {

/// A case throws this if its problem costs only a warning, also in strict loading. Such warnings have no code that a
/// test can see, so the case states it.
struct Warned {
  std::vector<std::string> warnings;
};

/// Provokes a problem in the current folder, which is empty before.
struct MessageCase {
  /// The problem's code.
  std::string_view code;
  std::function<void()> provoke;
  /// Whether the words in parentheses are those of a library or of the system, so that they differ between versions.
  bool quotes_others = false;
};

/// Problems of scene files and the files that they name. Strict ones too, so these sentences are warnings elsewhere.
std::vector<MessageCase> cases_of_files();
/// Problems of glTF files.
std::vector<MessageCase> cases_of_gltf();
/// Problems of scenes in memory, views, pictures, rays and BVH files.
std::vector<MessageCase> cases_of_values();
/// Problems of command lines.
std::vector<MessageCase> cases_of_usage();
/// Problems of jobs.
std::vector<MessageCase> cases_of_jobs();

/// Writes a file to the current folder.
void write_case(const std::string& name, std::string_view bytes);

}  // namespace promin
