// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/compare_channels.h"

#include <algorithm>
#include <iterator>

#include "core/parallel.h"
#include "image/channel_file.h"
#include "image/difference_of.h"
#include "image/exr_parts.h"
#include "image/name_size.h"

namespace promin {
namespace {

namespace fs = std::filesystem;

/// Memory in bytes for the rows of all parts of a file together. It is exceeded if the smallest number of rows needs
/// more.
constexpr uint64_t kMostBandBytes = uint64_t{4} << 20;
constexpr uint32_t kLeastRows = 32;
/// The largest number of channels of each file that a message names.
constexpr size_t kMostNamed = 5;

/// The channels of both files that have the same name.
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

/// Describes the channels that only one file has: "only b.exr has Z"; empty if there are none. Both lists are sorted by
/// name.
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

/// Returns pairs of channels with equal names, in the order of the first file.
std::vector<ChannelPair> pair_channels(const ChannelFile& reference, const ChannelFile& test) {
  const std::vector<const FileChannel*> of_reference = sort_by_name(reference);
  const std::vector<const FileChannel*> of_test = sort_by_name(test);
  const std::string in_reference = name_missing(reference.file(), of_reference, of_test);
  const std::string in_test = name_missing(test.file(), of_test, of_reference);
  if (!in_reference.empty() || !in_test.empty()) {
    const std::string between = in_reference.empty() || in_test.empty() ? "" : ", ";
    throw InputError({"picture.pair.channels",
                      "the pictures have different channels: " + in_reference + between + in_test, "",
                      "write both with the same --aov"});
  }
  std::vector<ChannelPair> pairs;
  for (size_t i = 0; i < of_reference.size(); ++i) pairs.push_back({of_reference[i], of_test[i]});
  std::ranges::sort(pairs, {}, &ChannelPair::reference);
  std::erase_if(pairs, [](const ChannelPair& pair) { return is_color_channel(pair.reference->name); });
  for (const ChannelPair& pair : pairs) {
    if (pair.reference->size == pair.test->size) continue;
    throw InputError({"picture.pair.sizes",
                      "the pictures have different sizes in " + pair.reference->name + ", " +
                          name_size(pair.reference->size) + " and " + name_size(pair.test->size),
                      "", "render both at the same size"});
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
