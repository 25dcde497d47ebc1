// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <future>
#include <optional>
#include <vector>

#include "image/picture_writer.h"
#include "promin/aovs.h"
#include "promin/image.h"
#include "promin/scene.h"
#include "promin/view.h"

namespace promin::app {

/// Returns the channels of an EXR for a choice of AOVs, with their values. With `hides_unlit` those of Aovs::unlit are
/// hidden. AOVs and channels of a wide picture take much memory, so each AOV is freed when its channels are made.
std::vector<Channel> make_channels(const Scene& scene, Aovs aovs, const AovSet& choice, bool hides_unlit);

/// What the header of an EXR tells of these AOVs, without values.
struct AovHeader {
  std::vector<Channel> channels;
  Metadata metadata;
};
AovHeader describe_aovs(const Scene& scene, const AovSet& choice, bool hides_unlit, DepthKind depth_kind);

/// Cuts a window into bands of whole rows, so that what is held of a band at a time is bounded. `channel_count` is that
/// of all four-byte numbers of a pixel.
std::vector<PixelWindow> cut_bands(const PixelWindow& window, size_t channel_count);

/// The files of one picture, written band after band while the next is traced. Without commit() nothing stays behind.
class PictureFiles {
 public:
  /// Throws as write_image.
  PictureFiles(const std::vector<std::filesystem::path>& files, const PictureHeader& header);
  ~PictureFiles();
  PictureFiles(const PictureFiles&) = delete;
  PictureFiles& operator=(const PictureFiles&) = delete;

  /// The next rows; returns before they are written, and throws what the rows before came to.
  void write_rows(Image rows, std::vector<Channel> channels);
  void commit();
  /// Until the rows before are written and no memory is held for them; throws what they came to.
  void wait();

 private:
  std::vector<PictureWriter> writers_;
  Image rows_;
  std::vector<Channel> channels_;
  std::future<void> writing_;
};

}  // namespace promin::app
