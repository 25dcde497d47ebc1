// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/driver_files.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>

#include "core/address_space.h"
#include "core/parallel.h"

namespace promin::gpu {
namespace fs = std::filesystem;

namespace {

/// Returns the fault of a manifest; empty if it is valid. A folder that contains manifests is valid too.
std::string find_fault(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return "does not exist";
  if (fs::is_directory(file, error)) return "";
  std::ifstream stream(file);
  if (!stream) return "cannot be read";
  return nlohmann::json::accept(stream) ? "" : "is not JSON";
}

/// Returns the first fault among the files that a variable names; colons separate the files.
std::optional<Problem> find_fault_in(const std::string& variable, const std::string& files) {
  std::istringstream list(files);
  for (std::string file; std::getline(list, file, ':');) {
    const std::string fault = file.empty() ? "" : find_fault(file);
    if (fault.empty()) continue;
    return Problem{"device.driver.manifest",
                   "there is no Vulkan device: the manifest of a driver, which " + variable + " names, " + fault, file,
                   "correct " + variable + " or unset it"};
  }
  return std::nullopt;
}

constexpr const char* kVariables[] = {"VK_DRIVER_FILES", "VK_ICD_FILENAMES", "VK_ADD_DRIVER_FILES"};

}  // namespace

std::optional<Problem> find_lack_of_address_space() {
  // The address space that lavapipe of Mesa 22.3 needs: for LLVM, for the kernels of a typical scene, and for the
  // stacks of two threads per core or their equivalent in newer versions.
  constexpr uint64_t kDriverBytes = uint64_t{256} << 20;
  constexpr uint64_t kCoreBytes = uint64_t{2 * 8} << 20;
  constexpr unsigned kMostCores = 32;
  return find_lack_of_space("a Vulkan driver", kDriverBytes + kCoreBytes * std::min(core_count(), kMostCores));
}

std::optional<Problem> find_manifest_fault() {
  for (const char* variable : kVariables) {
    const char* files = std::getenv(variable);
    auto fault = files == nullptr ? std::nullopt : find_fault_in(variable, files);
    if (fault) return fault;
  }
  return std::nullopt;
}

Problem explain_missing_driver() {
  if (auto lack = find_lack_of_address_space()) return *lack;
  if (auto fault = find_manifest_fault()) return *fault;
  for (const std::string variable : kVariables) {
    const char* files = std::getenv(variable.c_str());
    if (files == nullptr) continue;
    return {"device.missing", "there is no Vulkan device", variable + " with \"" + files + "\"",
            "name a driver's manifest in " + variable + " or unset it"};
  }
  return {"device.missing", "there is no Vulkan device", "", "install a driver such as mesa-vulkan-drivers"};
}

}  // namespace promin::gpu
