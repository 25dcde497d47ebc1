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

/// A file of a picture that a scene's textures show.
struct PictureSource {
  /// Gets its size and texels when it is decoded; the rest is the reader's.
  std::shared_ptr<TextureImage> image = std::make_shared<TextureImage>();
  /// Whether it gets its texels, or its size alone.
  bool takes_texels = true;
  /// In a buffer that outlives this, or in `own`.
  std::span<const std::byte> file = {};
  std::vector<std::byte> own = {};
  /// What messages call it.
  std::string title = {};
  /// Why it cannot be used; nothing where it can.
  std::optional<Fault> problem = std::nullopt;
  /// Whether the file is broken or missing. It is not where its format allows what promin does not read.
  bool is_file_at_fault = true;
};

/// The problem in one line.
std::string describe_problem(const PictureSource& source);

/// Gives the first `most_bytes` of a picture's file, or all where it has no more; a few more are no harm. nullopt once
/// the report holds the reason.
using ReadPictureBytes = std::function<std::optional<std::vector<std::byte>>(LoadReport& report, uint64_t most_bytes)>;

/// Takes the bytes that `read`, called with a report of its own, gives for the source: the whole file, or its first
/// 64 KiB where the source takes no texels and these tell the size. What would refuse a scene's other files is no more
/// than the source's problem: the scene can be shown without.
void read_picture(PictureSource& source, LoadReport& report, const ReadPictureBytes& read);

/// Decodes all pictures on all cores, or reads the sizes of those that take no texels. Those for which that fails, and
/// those that are damaged but decoded, are warned about once for each kind; the images of the former stay without. A
/// strict report refuses those whose files are at fault.
void decode_pictures(std::span<PictureSource> sources, LoadReport& report);

}  // namespace promin
