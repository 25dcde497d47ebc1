// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "console.h"
#include "promin/device.h"
#include "promin/image.h"
#include "render_options.h"

namespace promin::app {

/// Renders a scene by checked options and returns the picture as a PNG shows it: exposed and tone mapped, in linear
/// light, so that write_image without a display transform gives the codes of `promin render`. options.pictures names a
/// file, which is not written. Throws InputError, UsageError for what the scene does not have, and RunError.
Image render_shown(const RenderOptions& options, const gpu::Device& device, const Console& console);

}  // namespace promin::app
