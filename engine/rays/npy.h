// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>

#include "core/file.h"
#include "promin/ray.h"

namespace promin {

/// Reads rays from a NumPy file piece by piece: an array of N x 8 little-endian float32 in C order, a row being origin
/// xyz, tmin, direction xyz, tmax. N may be 0. NumPy's format 1.0, 2.0 and 3.0 (numpy.lib.format).
class RayReader {
 public:
  /// Throws InputError if the file is anything else, or shorter or longer than its header says.
  explicit RayReader(const std::filesystem::path& file);

  uint64_t count() const { return count_; }

  /// Reads the next rays, as many as fit in `rays`, but not more than are left. Throws InputError.
  void read(std::span<Ray> rays);

 private:
  std::filesystem::path file_;
  std::ifstream stream_;
  uint64_t count_ = 0;
};

/// Writes rays as a file that RayReader reads, whole or not at all. Throws RunError.
void write_rays(const std::filesystem::path& file, std::span<const Ray> rays);

/// Writes hits to a NumPy file piece by piece: a structured array of 32 packed bytes a hit with the fields t, object,
/// primitive, u, v, normal. The file appears whole on commit() or not at all. Throws RunError.
class HitWriter {
 public:
  HitWriter(const std::filesystem::path& file, uint64_t count);

  void write(std::span<const Hit> hits);
  /// Is called after `count` hits.
  void commit();

 private:
  void check() const;

  std::filesystem::path target_;
  AtomicFile output_;
  std::ofstream stream_;
  uint64_t missing_;
};

}  // namespace promin
