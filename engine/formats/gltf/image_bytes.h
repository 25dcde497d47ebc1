// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "formats/gltf/document.h"
#include "formats/picture_sources.h"

namespace promin {

/// Finds the file of images[index] in the document's buffers, beside the scene or in the document's text, and reads it
/// as read_picture does. Problems are stored in the source; the report only records that the file was searched for.
void read_gltf_image(const GltfDocument& document, size_t index, PictureSource& source, LoadReport& report);

}  // namespace promin
