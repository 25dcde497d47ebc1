// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
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
  /// In a buffer that outlives this, or in `own`.
  std::span<const std::byte> file = {};
  std::vector<std::byte> own = {};
  /// What messages call it.
  std::string title = {};
  /// Why it cannot be used; empty where it can.
  std::string problem = {};
};

/// Takes the bytes that `read`, called with a report of its own, gives for the source. What would refuse a scene's
/// other files is no more than the source's problem: the scene can be shown without.
template <class Read>
void read_picture(PictureSource& source, LoadReport& report, const Read& read) {
  LoadReport attempt(report.file());
  std::optional<std::vector<std::byte>> bytes;
  try {
    bytes = read(attempt);
    attempt.throw_if_refused();
  } catch (const InputError& error) {
    source.problem = error.problems().front().what;
  }
  for (const SourceFile& file : attempt.sources()) report.add_source(file.file);
  if (!source.problem.empty()) return;
  source.own = std::move(*bytes);
  source.file = source.own;
}

/// Decodes all pictures on all cores, or reads their sizes alone. One for which that fails is warned about, and its
/// image stays without.
void decode_pictures(std::span<PictureSource> sources, bool takes_texels, LoadReport& report);

}  // namespace promin
