// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>

/// Returns an input that reads a Radiance picture with its top row first and its rows from left to right, for every
/// order in the file ("-Y 32 +X 64" is this order, and "+Y 32 +X 64" has the bottom row first). OpenImageIO reports the
/// order only as an attribute. Other inputs are returned unchanged.
std::unique_ptr<OIIO::ImageInput> make_upright(std::unique_ptr<OIIO::ImageInput> input);
