// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "image/opened_picture.h"
#include "promin/math.h"

namespace promin {

/// A channel of a picture file.
struct FileChannel {
  std::string name;
  bool is_integer = false;
  /// Of its part.
  uvec2 size{0};
  size_t part = 0;
  /// Among the part's channels.
  size_t place = 0;
};

/// All channels of a picture file, those of all parts of an EXR, some rows at a time. It does not matter whether they
/// lie in one part or in several: a channel of a part has its own name where the part is the one that
/// ExrOptions::is_multipart puts it into, and as a colour of the first, else the part's name and a dot before it. Alpha
/// is kept apart from colours, but of EXR and WebP. Everything throws as read_image does.
class ChannelFile {
 public:
  explicit ChannelFile(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  /// In the file's order.
  const std::vector<FileChannel>& channels() const { return channels_; }

  /// Of the part with the most.
  uint32_t row_count() const;
  /// Of all parts together.
  uint64_t row_bytes() const;

  /// Reads the rows from `begin` to `end` of all parts that reach so far down.
  void read_rows(uint32_t begin, uint32_t end);

  /// The integer or the float's bits of a pixel in the rows that were read last.
  uint32_t bits(const FileChannel& channel, uint32_t x, uint32_t y) const {
    const Part& part = parts_[channel.part];
    const size_t pixel = size_t{y - first_row_} * part.size.x + x;
    return part.values[pixel * part.channel_count + channel.place];
  }
  double value(const FileChannel& channel, uint32_t x, uint32_t y) const;

 private:
  struct Part {
    uvec2 size{0};
    size_t channel_count = 0;
    std::vector<uint32_t> values;
  };

  std::filesystem::path file_;
  OpenedPicture picture_;
  std::vector<Part> parts_;
  std::vector<FileChannel> channels_;
  uint32_t first_row_ = 0;
};

}  // namespace promin
