// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>

/// A Radiance picture whose first row is the highest and whose rows run to the right, whatever order its file has
/// ("-Y 32 +X 64" is this one, and "+Y 32 +X 64" has the lowest row first), which OpenImageIO passes on as an
/// attribute. Any other input comes back as it is.
std::unique_ptr<OIIO::ImageInput> make_upright(std::unique_ptr<OIIO::ImageInput> input);
