// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/file.h"
#include "promin/ray.h"

namespace promin {

/// Reads rays from a NumPy file piece by piece: an array of N x 8 little-endian float32 or float64 in C order. A row is
/// origin xyz, tmin, direction xyz, tmax. N may be 0. Supports NumPy's formats 1.0, 2.0 and 3.0 (numpy.lib.format).
class RayReader {
 public:
  /// Opens the file. Throws InputError if it is anything else, or shorter or longer than its header says.
  explicit RayReader(const std::filesystem::path& file);

  uint64_t count() const { return count_; }

  /// Moves to the ray with this index, from which read() continues.
  void seek(uint64_t ray);
  /// Reads the next rays, as many as fit in `rays`, but not more than remain. The center (Scene::center) is subtracted
  /// from their origins in double; then float64 is rounded to float32. Throws InputError.
  void read(std::span<Ray> rays, const dvec3& center = dvec3(0.0));

 private:
  template <typename Number>
  void convert(std::span<Ray> rays, const dvec3& center);
  void read_bytes(std::span<std::byte> bytes);

  std::filesystem::path file_;
  std::ifstream stream_;
  uint64_t count_ = 0;
  uint64_t ray_bytes_ = sizeof(Ray);
  std::streamoff begin_ = 0;
};

/// Writes rays to a file for RayReader, completely or not at all. Throws RunError.
void write_rays(const std::filesystem::path& file, std::span<const Ray> rays);

/// Writes an array of one axis to a NumPy file piece by piece. The file appears complete on commit(), or not at all.
/// Throws RunError.
class ArrayWriter {
 public:
  /// Completes the file after all elements.
  void commit();
  /// Does the same for several files: either all of them appear or none.
  static void commit_together(std::initializer_list<ArrayWriter*> writers);

 protected:
  /// `type` is written like numpy.dtype.descr. If `count`, the number of elements, is empty, the number written at the
  /// end is used.
  ArrayWriter(const std::filesystem::path& file, std::string_view type, std::optional<uint64_t> count);
  void write(std::span<const std::byte> bytes, uint64_t count);

 private:
  void finish();
  void check() const;

  std::filesystem::path target_;
  AtomicFile output_;
  std::ofstream stream_;
  std::string type_;
  std::optional<uint64_t> count_;
  uint64_t written_ = 0;
};

/// Writes hits as a structured array of 32 packed bytes per hit with the fields t, object, primitive, u, v, normal.
class HitWriter : public ArrayWriter {
 public:
  explicit HitWriter(const std::filesystem::path& file, std::optional<uint64_t> count = std::nullopt);
  void write(std::span<const Hit> hits) { ArrayWriter::write(std::as_bytes(hits), hits.size()); }
};

/// Writes numbers of crossings as little-endian int32.
class CountWriter : public ArrayWriter {
 public:
  CountWriter(const std::filesystem::path& file, uint64_t count);
  void write(std::span<const int32_t> counts) { ArrayWriter::write(std::as_bytes(counts), counts.size()); }
};

/// Writes the indices where the hits of each ray begin and where those of the last ray end, as little-endian uint64.
class OffsetWriter : public ArrayWriter {
 public:
  OffsetWriter(const std::filesystem::path& file, uint64_t count);
  void write(std::span<const uint64_t> offsets) { ArrayWriter::write(std::as_bytes(offsets), offsets.size()); }
};

}  // namespace promin
