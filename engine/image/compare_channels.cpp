// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/compare_channels.h"

#include <algorithm>
#include <bit>
#include <iterator>

#include "core/parallel.h"
#include "image/difference_of.h"
#include "image/exr_parts.h"
#include "image/opened_picture.h"

namespace promin {
namespace {

namespace fs = std::filesystem;

/// Memory for the rows of all parts of a file together, unless the smallest number of rows needs more.
constexpr uint64_t kMostBandBytes = uint64_t{4} << 20;
constexpr uint32_t kLeastRows = 32;
/// Channels that a message names, of each file.
constexpr size_t kMostNamed = 5;

struct FileChannel {
  std::string name;
  bool is_integer = false;
  /// Of its part.
  uvec2 size{0};
  size_t part = 0;
  /// Among the part's channels.
  size_t place = 0;
};

/// All channels of a file, some rows at a time.
class ChannelFile {
 public:
  explicit ChannelFile(const fs::path& file) : file_(file), picture_(file) {
    const uint32_t part_count = picture_.info().part_count;
    for (uint32_t number = 0; number < part_count; ++number) {
      const ProminPicturesPart part = picture_.describe_part(number);
      const std::string part_name = part.name;
      parts_.push_back({uvec2(part.width, part.height), part.channel_count, {}});
      for (size_t i = 0; i < part.channel_count; ++i) {
        const ProminPicturesChannel& channel = part.channels[i];
        const std::string group = part_of_channel(channel.name);
        // R, G and B of the first part are the picture, whatever the part is called.
        const bool is_ours = part_count == 1 || group == part_name || (number == 0 && group == kColorPart);
        channels_.push_back({is_ours ? channel.name : part_name + "." + channel.name,
                             channel.sample == PROMIN_PICTURES_UINT32, parts_.back().size, number, i});
      }
    }
  }

  const fs::path& file() const { return file_; }
  /// In the file's order.
  const std::vector<FileChannel>& channels() const { return channels_; }

  uint32_t row_count() const {
    uint32_t count = 0;
    for (const Part& part : parts_) count = std::max(count, part.size.y);
    return count;
  }

  uint64_t row_bytes() const {
    uint64_t bytes = 0;
    for (const Part& part : parts_) bytes += part.size.x * part.channel_count * sizeof(uint32_t);
    return bytes;
  }

  /// Of all parts that reach so far down.
  void read_rows(uint32_t begin, uint32_t end) {
    for (size_t i = 0; i < parts_.size(); ++i) {
      Part& part = parts_[i];
      const uint32_t last = std::min(end, part.size.y);
      if (begin >= last) continue;
      part.values.resize(size_t{last - begin} * part.size.x * part.channel_count);
      picture_.read_rows(static_cast<uint32_t>(i), begin, last - begin, part.values.data());
    }
    first_row_ = begin;
  }

  /// Returns a pixel's value in the rows that were read last.
  double value(const FileChannel& channel, uint32_t x, uint32_t y) const {
    const Part& part = parts_[channel.part];
    const size_t pixel = size_t{y - first_row_} * part.size.x + x;
    const uint32_t bits = part.values[pixel * part.channel_count + channel.place];
    return channel.is_integer ? static_cast<double>(bits) : static_cast<double>(std::bit_cast<float>(bits));
  }

 private:
  struct Part {
    uvec2 size{0};
    size_t channel_count = 0;
    std::vector<uint32_t> values;
  };

  fs::path file_;
  OpenedPicture picture_;
  std::vector<Part> parts_;
  std::vector<FileChannel> channels_;
  uint32_t first_row_ = 0;
};

/// Of both files the channels of one name.
struct ChannelPair {
  const FileChannel* reference = nullptr;
  const FileChannel* test = nullptr;
};

std::vector<const FileChannel*> sort_by_name(const ChannelFile& file) {
  std::vector<const FileChannel*> sorted;
  for (const FileChannel& channel : file.channels()) sorted.push_back(&channel);
  std::ranges::stable_sort(sorted, {}, &FileChannel::name);
  return sorted;
}

/// Describes channels that only one file has; both lists are sorted by name: "only b.exr has Z", or nothing where there
/// is none.
std::string name_missing(const fs::path& file, const std::vector<const FileChannel*>& channels,
                         const std::vector<const FileChannel*>& others) {
  std::vector<const FileChannel*> missing;
  std::ranges::set_difference(channels, others, std::back_inserter(missing), {}, &FileChannel::name,
                              &FileChannel::name);
  if (missing.empty()) return "";
  std::string names = "only " + file.string() + " has";
  for (size_t i = 0; i < std::min(missing.size(), kMostNamed); ++i) names += " " + missing[i]->name;
  if (missing.size() > kMostNamed) names += " and " + std::to_string(missing.size() - kMostNamed) + " more";
  return names;
}

std::string name_size(const uvec2& size) {
  return std::to_string(size.x) + "x" + std::to_string(size.y);
}

/// Pairs of channels in the order of the first file.
std::vector<ChannelPair> pair_channels(const ChannelFile& reference, const ChannelFile& test) {
  const std::vector<const FileChannel*> of_reference = sort_by_name(reference);
  const std::vector<const FileChannel*> of_test = sort_by_name(test);
  const std::string in_reference = name_missing(reference.file(), of_reference, of_test);
  const std::string in_test = name_missing(test.file(), of_test, of_reference);
  if (!in_reference.empty() || !in_test.empty()) {
    const std::string between = in_reference.empty() || in_test.empty() ? "" : "; ";
    throw InputError(
        {"the pictures have different channels", in_reference + between + in_test, "write both with the same --aov"});
  }
  std::vector<ChannelPair> pairs;
  for (size_t i = 0; i < of_reference.size(); ++i) pairs.push_back({of_reference[i], of_test[i]});
  std::ranges::sort(pairs, {}, &ChannelPair::reference);
  std::erase_if(pairs, [](const ChannelPair& pair) { return is_color_channel(pair.reference->name); });
  for (const ChannelPair& pair : pairs) {
    if (pair.reference->size == pair.test->size) continue;
    throw InputError({"the pictures have different sizes in " + pair.reference->name,
                      name_size(pair.reference->size) + " against " + name_size(pair.test->size),
                      "render both at the same size"});
  }
  return pairs;
}

}  // namespace

std::vector<ChannelDifference> compare_other_channels(const fs::path& reference, const fs::path& test, double allowed) {
  ChannelFile a(reference);
  ChannelFile b(test);
  const std::vector<ChannelPair> pairs = pair_channels(a, b);
  std::vector<ChannelDifference> differences;
  for (const ChannelPair& pair : pairs) {
    const uvec2& size = pair.reference->size;
    differences.push_back({.name = pair.reference->name, .pixel_count = uint64_t{size.x} * size.y});
  }
  if (pairs.empty()) return differences;

  const uint64_t fitting_rows = kMostBandBytes / std::max(a.row_bytes(), b.row_bytes());
  const auto rows = std::max(static_cast<uint32_t>(fitting_rows / kLeastRows * kLeastRows), kLeastRows);
  for (uint32_t begin = 0; begin < a.row_count(); begin += rows) {
    const uint32_t end = std::min(begin + rows, a.row_count());
    a.read_rows(begin, end);
    b.read_rows(begin, end);
    for_each_index(pairs.size(), 0, [&](size_t i) {
      const ChannelPair& pair = pairs[i];
      const uvec2& size = pair.reference->size;
      ChannelDifference& result = differences[i];
      for (uint32_t y = begin; y < std::min(end, size.y); ++y) {
        for (uint32_t x = 0; x < size.x; ++x) {
          const double difference = difference_of(a.value(*pair.reference, x, y), b.value(*pair.test, x, y));
          result.different_count += difference > allowed ? 1 : 0;
          if (difference <= result.largest) continue;
          result.largest = difference;
          result.largest_at = uvec2(x, y);
        }
      }
    });
  }
  return differences;
}

}  // namespace promin
