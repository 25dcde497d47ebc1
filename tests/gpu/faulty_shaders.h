// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "support/read_spirv.h"
#include "trace/render/renderer_impl.h"

namespace promin::test {

/// The kernels of pictures with a fault from tests/faults/seed_fault.py.
class FaultyShaders {
 public:
  explicit FaultyShaders(const std::string& fault)
      : camera_stage_(read(fault, "camera_stage")),
        trace_shadow_rays_(read(fault, "trace_shadow_rays")),
        follow_paths_(read(fault, "follow_paths")) {}
  PictureShaders shaders() const { return {camera_stage_, trace_shadow_rays_, follow_paths_}; }

 private:
  static std::vector<uint32_t> read(const std::string& fault, const std::string& kernel) {
    return read_spirv(std::filesystem::path(PROMIN_FAULTS_DIR) / fault / (kernel + ".spv"));
  }

  std::vector<uint32_t> camera_stage_;
  std::vector<uint32_t> trace_shadow_rays_;
  std::vector<uint32_t> follow_paths_;
};

}  // namespace promin::test
