// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/picture_sources.h"

#include "core/parallel.h"
#include "textures/decode_picture.h"

namespace promin {

void decode_pictures(std::span<PictureSource> sources, bool takes_texels, LoadReport& report) {
  for_each_index(sources.size(), 0, [&](size_t i) {
    PictureSource& source = sources[i];
    if (!source.problem.empty()) return;
    try {
      if (takes_texels) {
        DecodedPicture picture = decode_picture(source.file);
        source.image->size = picture.size;
        source.image->texels = std::move(picture.texels);
      } else {
        source.image->size = read_picture_size(source.file);
      }
    } catch (const PictureError& error) {
      source.problem = error.what();
    }
    source.own = {};
  });
  for (const PictureSource& source : sources) {
    if (!source.problem.empty()) report.warn("image " + source.title + " is ignored: " + source.problem);
  }
}

}  // namespace promin
