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
  /// Width and height of the channel's part of the file.
  uvec2 size{0};
  size_t part = 0;
  /// Index of the channel among the channels of its part.
  size_t place = 0;
};

/// Reads all channels of a picture file, some rows at a time; in an EXR the channels of all parts. In a file with
/// several parts, a channel keeps its own name if the name begins with the part's name (N.x in the part "N"), or if it
/// is a colour of the first part. Otherwise the part's name and a dot are put before its name. Colours of EXR and WebP
/// files are multiplied by alpha; colours of other files are not. Every function throws the same errors as
/// read_image().
class ChannelFile {
 public:
  explicit ChannelFile(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  /// Returns the channels in the file's order.
  const std::vector<FileChannel>& channels() const { return channels_; }

  /// Returns the number of rows of the part that has the most rows.
  uint32_t row_count() const;
  /// Returns the number of bytes of a row of all parts together.
  uint64_t row_bytes() const;

  /// Reads the rows from `begin` to `end` of all parts that have these rows.
  void read_rows(uint32_t begin, uint32_t end);

  /// Returns the value of a pixel: the integer, or the bits of the float. The pixel must be in the rows that were read
  /// last.
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
