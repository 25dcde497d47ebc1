// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "image/picture_writer.h"
#include "promin/aovs.h"
#include "promin/image.h"
#include "promin/scene.h"
#include "promin/view.h"
#include "work/pictures/film_file.h"

namespace promin::work {

/// Returns the channels of an EXR for a choice of AOVs, with their values. With `hides_unlit`, the channels of
/// Aovs::unlit are hidden. AOVs and channels of a wide picture take much memory, so each AOV is freed when its channels
/// are made.
std::vector<Channel> make_channels(const Scene& scene, Aovs aovs, const AovSet& choice, bool hides_unlit);

/// Channels and metadata for the header of an EXR with these AOVs. The channels have no values.
struct AovHeader {
  std::vector<Channel> channels;
  Metadata metadata;
};
AovHeader describe_aovs(const Scene& scene, const AovSet& choice, bool hides_unlit, DepthKind depth_kind);

/// Divides a window into bands of whole rows, so that the memory for a band is bounded. `channel_count` is the number
/// of four-byte values of a pixel.
std::vector<PixelWindow> cut_bands(const PixelWindow& window, size_t channel_count);

/// Films to which the same frames are added.
using Films = std::vector<std::unique_ptr<FilmFile>>;

/// The files of one picture, and the films of which it is the next frame. A band is written while the next band is
/// traced. Without commit() no file remains.
class PictureFiles {
 public:
  /// The films must outlive this object. Throws the same errors as write_image().
  PictureFiles(const std::vector<std::filesystem::path>& files, const PictureHeader& header, const Films& films = {});
  ~PictureFiles();
  PictureFiles(const PictureFiles&) = delete;
  PictureFiles& operator=(const PictureFiles&) = delete;

  /// Adds the next rows. Returns before they are written. Throws exceptions from writing earlier rows.
  void write_rows(Image rows, std::vector<Channel> channels);
  /// Completes the files of this picture. Films remain open for further frames.
  void commit();
  /// Waits until all rows are written and their memory is free. Throws exceptions from writing them.
  void wait();

 private:
  std::vector<PictureWriter> writers_;
  std::vector<FilmFile*> films_;
  DisplayTransform display_;
  /// The position of the picture's upper left pixel in the whole picture.
  uvec2 lo_{0};
  Image rows_;
  std::vector<Channel> channels_;
  std::future<void> writing_;
};

}  // namespace promin::work
