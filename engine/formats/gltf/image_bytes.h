// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "formats/gltf/document.h"
#include "formats/picture_sources.h"

namespace promin {

/// Finds the file of images[index], which lies in the document's buffers, beside the scene or in the document's text,
/// and takes it as read_picture does. Whatever is wrong with it is the source's problem; the report holds no more than
/// that a file was looked for.
void read_gltf_image(const GltfDocument& document, size_t index, PictureSource& source, LoadReport& report);

}  // namespace promin
