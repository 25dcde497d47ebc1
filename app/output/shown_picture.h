// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/render_options.h"
#include "output/console.h"
#include "promin/device.h"
#include "promin/image.h"

namespace promin::app {

/// Renders a scene by checked options and returns the picture as displayed: exposed and tone mapped, in linear light,
/// so that write_image without a display transform gives the same sRGB values as `promin render`. options.pictures
/// names a file, which is not written. Throws InputError, RunError, and UsageError if the options refer to something
/// that the scene does not have.
Image render_shown(const RenderSpec& options, const gpu::Device& device, const Console& console);

}  // namespace promin::app
