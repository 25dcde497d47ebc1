// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/channel_file.h"

#include <algorithm>
#include <bit>

#include "image/exr_parts.h"

namespace promin {

ChannelFile::ChannelFile(const std::filesystem::path& file) : file_(file), picture_(file) {
  const uint32_t part_count = picture_.info().part_count;
  for (uint32_t number = 0; number < part_count; ++number) {
    const ProminPicturesPart part = picture_.describe_part(number);
    const std::string part_name = part.name;
    parts_.push_back({uvec2(part.width, part.height), part.channel_count, {}});
    for (size_t i = 0; i < part.channel_count; ++i) {
      const ProminPicturesChannel& channel = part.channels[i];
      const std::string group = part_of_channel(channel.name);
      // R, G and B of the first part are the picture, for every name of the part.
      const bool is_ours = part_count == 1 || group == part_name || (number == 0 && group == kColorPart);
      channels_.push_back({is_ours ? channel.name : part_name + "." + channel.name,
                           channel.sample == PROMIN_PICTURES_UINT32, parts_.back().size, number, i});
    }
  }
}

uint32_t ChannelFile::row_count() const {
  uint32_t count = 0;
  for (const Part& part : parts_) count = std::max(count, part.size.y);
  return count;
}

uint64_t ChannelFile::row_bytes() const {
  uint64_t bytes = 0;
  for (const Part& part : parts_) bytes += part.size.x * part.channel_count * sizeof(uint32_t);
  return bytes;
}

void ChannelFile::read_rows(uint32_t begin, uint32_t end) {
  for (size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    const uint32_t last = std::min(end, part.size.y);
    if (begin >= last) continue;
    part.values.resize(size_t{last - begin} * part.size.x * part.channel_count);
    picture_.read_rows(static_cast<uint32_t>(i), begin, last - begin, part.values.data());
  }
  first_row_ = begin;
}

double ChannelFile::value(const FileChannel& channel, uint32_t x, uint32_t y) const {
  const uint32_t number = bits(channel, x, y);
  return channel.is_integer ? static_cast<double>(number) : static_cast<double>(std::bit_cast<float>(number));
}

}  // namespace promin
