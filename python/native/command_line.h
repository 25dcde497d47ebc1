// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <optional>
#include <string>
#include <vector>

#include "promin/aovs.h"
#include "promin/device_info.h"
#include "promin/display.h"
#include "promin/image.h"
#include "promin/renderer.h"
#include "promin/scene.h"
#include "promin/view.h"
#include "render_options.h"

namespace promin::python {

/// Returns the options of `promin render` that these words give, read as on the command line. Throws UsageError.
app::RenderOptions read_options(const std::vector<std::string>& words);

/// Returns the metadata that `promin render` writes into the header of an EXR. `named` has the objects and materials
/// whose names Cryptomatte stores.
Metadata describe_picture(const View& view, const DisplayTransform& display, const std::optional<PictureError>& error,
                          const gpu::DeviceInfo& device, const std::string& scene_file, const Scene& named,
                          const AovSet& aovs);

}  // namespace promin::python
