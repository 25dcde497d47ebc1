// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/load_report.h"
#include "promin/textures.h"

namespace promin {

/// The picture file of a scene's texture image.
struct PictureSource {
  /// The image. Decoding sets its size and texels; the reader sets all other members.
  std::shared_ptr<TextureImage> image = std::make_shared<TextureImage>();
  /// If true, the texels are decoded; otherwise only the size is read.
  bool takes_texels = true;
  /// The file's bytes, in a buffer that outlives this object or in `own`.
  std::span<const std::byte> file = {};
  std::vector<std::byte> own = {};
  /// The picture's title in messages.
  std::string title = {};
  /// The reason why the picture cannot be used, if there is one.
  std::optional<Fault> problem = std::nullopt;
  /// True if the file is damaged or missing; false if the file is valid but not supported.
  bool is_file_at_fault = true;
};

/// Returns the problem in one line.
std::string describe_problem(const PictureSource& source);

/// A function that returns the first `most_bytes` of a picture's file, or the whole file if it is shorter; it may
/// return a few bytes more. If it fails, it adds the reason to the report and returns nullopt.
using ReadPictureBytes = std::function<std::optional<std::vector<std::byte>>(LoadReport& report, uint64_t most_bytes)>;

/// Reads the bytes of the source with `read`, which receives a separate report. It reads the whole file, or only its
/// first 64 KiB if only the size is needed and they contain it. A fault of the file only becomes the source's problem
/// and does not refuse the scene, because the scene can be shown without the picture.
void read_picture(PictureSource& source, LoadReport& report, const ReadPictureBytes& read);

/// Decodes all pictures on all cores, or only reads their sizes. Warns once for each kind of failure, and of damaged
/// pictures that could be decoded. Images of failed pictures get no texels. A strict report refuses pictures whose
/// files are at fault.
void decode_pictures(std::span<PictureSource> sources, LoadReport& report);

}  // namespace promin
