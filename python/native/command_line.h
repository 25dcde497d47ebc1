// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <concepts>
#include <optional>
#include <string>
#include <vector>

#include "promin/aovs.h"
#include "promin/device_info.h"
#include "promin/display.h"
#include "promin/error.h"
#include "promin/image.h"
#include "promin/renderer.h"
#include "promin/scene.h"
#include "promin/view.h"
#include "work/spec/render_spec.h"

namespace promin::python {

/// Returns the options of `promin render` that these words give, read as on the command line. Throws UsageError.
work::RenderSpec read_options(const std::vector<std::string>& words);

/// Returns the sentence with Python's keywords in place of the options of `promin render`: look_at for --look-at.
std::string name_keywords(const std::string& sentence);

/// Returns the error with Python's keywords and without a place, because Python has no command line.
UsageError name_keywords(const UsageError& error);

/// Calls a function of the programs. A UsageError that it throws gets Python's keywords.
template <typename Function>
requires std::invocable<Function>
auto with_keywords(const Function& function) {
  try {
    return function();
  } catch (const UsageError& error) {
    throw name_keywords(error);
  }
}

/// What the header of an EXR tells of a picture that `promin render` has written. `named` has the objects and materials
/// whose names Cryptomatte tells.
Metadata describe_picture(const View& view, const DisplayTransform& display, const std::optional<PictureError>& error,
                          const gpu::DeviceInfo& device, const std::string& scene_file, const Scene& named,
                          const AovSet& aovs);

}  // namespace promin::python
