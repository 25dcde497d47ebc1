// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/picture_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string>

#include "promin/cryptomatte.h"

namespace promin::work {
namespace {

/// The largest size of a band's values in bytes. A few copies of them exist at a time.
constexpr size_t kBandBytes = size_t{12} << 20;
/// The number of rows of a band is a multiple of this, the size of an EXR's compression block, unless such a block
/// exceeds kBandBytes.
constexpr uint32_t kRowsOfBlock = 16;
/// The number of rows that a film traces at least.
constexpr uint32_t kLeastRows = 8;

// Returns an AOV's channels. The overloads differ in the type of its values, which are moved.

void add_aov_channels(const std::string& name, std::string_view /*components*/, std::vector<uint32_t> values,
                      std::vector<Channel>& channels) {
  channels.push_back({name, true, std::move(values)});
}

void add_aov_channels(const std::string& name, std::string_view /*components*/, std::vector<float> values,
                      std::vector<Channel>& channels) {
  Channel channel{name, false, std::vector<uint32_t>(values.size())};
  std::ranges::transform(values, channel.values.begin(), [](float value) { return std::bit_cast<uint32_t>(value); });
  channels.push_back(std::move(channel));
}

template <typename Vector>
void add_aov_channels(const std::string& name, std::string_view components, std::vector<Vector> values,
                      std::vector<Channel>& channels) {
  for (int axis = 0; axis < Vector::length(); ++axis) {
    Channel channel{name + "." + components[static_cast<size_t>(axis)], false, std::vector<uint32_t>(values.size())};
    std::ranges::transform(values, channel.values.begin(),
                           [axis](const Vector& value) { return std::bit_cast<uint32_t>(value[axis]); });
    channels.push_back(std::move(channel));
  }
}

}  // namespace

std::vector<Channel> make_channels(const Scene& scene, Aovs aovs, const AovSet& choice, bool hides_unlit) {
  std::vector<Channel> channels;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) \
  if (choice.FIELD) add_aov_channels(CHANNEL, COMPONENTS, std::move(aovs.FIELD), channels);
#include "promin/kinds/aovs.def"
  for (Channel& channel : channels) channel.is_hidden = hides_unlit && channel.name.starts_with("unlit.");
  if (choice.cryptomatte) {
    for (Channel& channel : make_cryptomatte(scene, aovs).channels) channels.push_back(std::move(channel));
  }
  return channels;
}

AovHeader describe_aovs(const Scene& scene, const AovSet& choice, bool hides_unlit, DepthKind depth_kind) {
  AovHeader header{make_channels(scene, Aovs(), choice, hides_unlit), {}};
  if (choice.depth) {
    header.metadata.emplace_back("promin:depth", depth_kind_names()[static_cast<size_t>(depth_kind)]);
  }
  if (choice.position && scene.center != dvec3(0.0)) {
    header.metadata.emplace_back("promin:center",
                                 fmt::format("{} {} {}", scene.center.x, scene.center.y, scene.center.z));
  }
  if (choice.cryptomatte) {
    for (auto& entry : make_cryptomatte(scene, Aovs()).metadata) header.metadata.push_back(std::move(entry));
  }
  return header;
}

std::vector<PixelWindow> cut_bands(const PixelWindow& window, size_t channel_count) {
  const uvec2 size = window.hi - window.lo;
  const size_t most_rows = kBandBytes / (channel_count * sizeof(float) * size.x) / kRowsOfBlock * kRowsOfBlock;
  const auto rows = static_cast<uint32_t>(std::min<size_t>(std::max<size_t>(most_rows, kLeastRows), size.y));
  std::vector<PixelWindow> bands;
  for (uint32_t y = 0; y < size.y; y += rows) {
    bands.push_back({window.lo + uvec2(0, y), {window.hi.x, window.lo.y + std::min(size.y, y + rows)}});
  }
  return bands;
}

PictureFiles::PictureFiles(const std::vector<std::filesystem::path>& files, const PictureHeader& header,
                           const Films& films)
    : display_(header.display), lo_(header.crop ? header.crop->lo : uvec2(0)) {
  for (const std::unique_ptr<FilmFile>& film : films) films_.push_back(film.get());
  for (const std::filesystem::path& file : files) writers_.emplace_back(file, header);
}

PictureFiles::~PictureFiles() {
  if (writing_.valid()) writing_.wait();
}

void PictureFiles::wait() {
  if (writing_.valid()) writing_.get();
}

void PictureFiles::write_rows(Image rows, std::vector<Channel> channels) {
  wait();
  rows_ = std::move(rows);
  channels_ = std::move(channels);
  // If no thread can be started, the function runs when its result is awaited.
  writing_ = std::async([this] {
    for (PictureWriter& writer : writers_) writer.write_rows(rows_, channels_);
    for (FilmFile* film : films_) film->write_rows(rows_, channels_, display_, lo_);
    // The rows are freed, because the next band needs the same amount of memory.
    rows_ = {};
    channels_ = {};
  });
}

void PictureFiles::commit() {
  wait();
  for (PictureWriter& writer : writers_) writer.commit();
}

}  // namespace promin::work
