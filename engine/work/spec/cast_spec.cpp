// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/spec/cast_spec.h"

namespace promin::work {

std::vector<std::filesystem::path> CastSpec::outputs() const {
  std::vector<std::filesystem::path> files;
  if (output) files.push_back(*output);
  if (offsets) files.push_back(*offsets);
  return files;
}

}  // namespace promin::work
