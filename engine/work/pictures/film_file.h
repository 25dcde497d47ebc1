// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "promin/display.h"
#include "promin/image.h"
#include "promin/math.h"

namespace promin::work {

/// Returns whether a file's extension is that of a film: .mp4, .webm or .gif.
bool is_film(const std::filesystem::path& file);
/// Returns whether the format of a film stores alpha. A GIF stores whether a pixel is transparent.
bool film_stores_alpha(const std::filesystem::path& file);
/// Returns whether a file stores all frames of a command: a film, or with several frames a .png without # in its name,
/// which becomes an animated PNG.
bool holds_all_frames(const std::filesystem::path& file, bool has_several_frames);
/// Returns the files that hold all frames.
std::vector<std::filesystem::path> films_among(const std::vector<std::filesystem::path>& files,
                                               bool has_several_frames);

/// The properties of a film that do not change from frame to frame.
struct FilmHeader {
  /// Width and height of the frames.
  uvec2 size{0};
  /// True if the frames have the channel "A". The film then has alpha, if its format stores it.
  bool has_alpha = false;
  double fps = 0.0;
  size_t frame_count = 0;
};

/// Throws UsageError if the format of a film does not allow this number of frames per second, and RunError if ffmpeg is
/// not installed.
void check_film(const std::filesystem::path& file, double fps);

/// A film that the program ffmpeg encodes while its frames are rendered. The file appears when it is complete. Without
/// commit() no file remains. Equal frames give equal bytes with the same version of ffmpeg. Frames are shown as a PNG
/// shows them (write_image). If the format needs even sides, it repeats the last column or row of odd ones.
class FilmFile {
 public:
  /// Starts ffmpeg. Throws the same errors as check_film().
  FilmFile(const std::filesystem::path& file, const FilmHeader& header);
  ~FilmFile();
  FilmFile(const FilmFile&) = delete;
  FilmFile& operator=(const FilmFile&) = delete;

  /// Adds the next rows of the current frame, from the top; after its last row the next frame begins. `lo` is the
  /// position of the frame's upper left pixel in the whole picture. Throws RunError.
  void write_rows(const Image& rows, std::span<const Channel> channels, const DisplayTransform& display,
                  const uvec2& lo);
  /// Completes the file after the last frame. Throws RunError.
  void commit();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin::work
