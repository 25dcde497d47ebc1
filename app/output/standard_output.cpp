// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/standard_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "core/file.h"
#include "promin/error.h"

namespace promin::app {

StandardOutput::StandardOutput(std::vector<std::filesystem::path>& pictures) {
  const auto found = std::find(pictures.begin(), pictures.end(), kName);
  if (found == pictures.end()) return;
  // The random name cannot be guessed by other users.
  std::random_device dice;
  file_ = std::filesystem::temp_directory_path() / fmt::format("promin-{:08x}{:08x}.png", dice(), dice());
  *found = file_;
}

StandardOutput::~StandardOutput() {
  std::error_code error;
  if (!file_.empty()) std::filesystem::remove(file_, error);
}

void StandardOutput::write() const {
  if (file_.empty()) return;
  const std::vector<std::byte> bytes = read_file(file_);
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0) {
    throw RunError(
        {"output.standard.closed", "the standard output cannot be written", "", "check where it is redirected"});
  }
}

}  // namespace promin::app
