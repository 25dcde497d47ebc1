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

/// Reads rays from a NumPy file piece by piece. The file is an array of N x 8 little-endian float32 or float64 in C
/// order. A row is origin xyz, tmin, direction xyz, tmax. N may be 0. Supports NumPy's formats 1.0, 2.0 and 3.0
/// (numpy.lib.format).
class RayReader {
 public:
  /// Opens the file. Throws InputError if the file has other content, or is shorter or longer than its header says.
  explicit RayReader(const std::filesystem::path& file);

  uint64_t count() const { return count_; }

  /// Moves to the ray with this index. read() continues from there.
  void seek(uint64_t ray);
  /// Fills `rays` with the next rays; there must be as many. The center (Scene::center) is subtracted from the origins
  /// in double; then float64 is rounded to float32. Throws InputError.
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

/// Writes rays to a file that RayReader can read, completely or not at all. Throws RunError.
void write_rays(const std::filesystem::path& file, std::span<const Ray> rays);

/// Writes an array of one axis to a NumPy file piece by piece. The complete file appears on commit(); without commit()
/// no file appears. Throws RunError.
class ArrayWriter {
 public:
  /// Completes the file after the last element.
  void commit();
  /// Completes several files: either all of them appear or none.
  static void commit_together(std::initializer_list<ArrayWriter*> writers);

 protected:
  /// `type` has the form of numpy.dtype.descr. If `count` is empty, the number of elements is the number that was
  /// written.
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

/// Writes offsets as little-endian uint64: the index of each ray's first hit, and then the end of the last ray's hits.
class OffsetWriter : public ArrayWriter {
 public:
  OffsetWriter(const std::filesystem::path& file, uint64_t count);
  void write(std::span<const uint64_t> offsets) { ArrayWriter::write(std::as_bytes(offsets), offsets.size()); }
};

}  // namespace promin
