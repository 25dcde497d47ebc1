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

/// Reads a specification of pictures, given as JSON. Throws UsageError, whose sentences have Python's keywords.
work::RenderSpec read_spec(const std::string& text);

/// Returns the sentence with Python's keywords in place of the options of `promin render`: look_at in place of
/// --look-at.
std::string name_keywords(const std::string& sentence);

/// Returns the error with Python's keywords. The result names no place, because Python has no command line.
UsageError name_keywords(const UsageError& error);

/// Calls a function of the programs. If the function throws a UsageError, its sentences get Python's keywords.
template <typename Function>
requires std::invocable<Function>
auto with_keywords(const Function& function) {
  try {
    return function();
  } catch (const UsageError& error) {
    throw name_keywords(error);
  }
}

/// Returns the metadata that `promin render` writes to the header of an EXR. `named` is a scene with the objects and
/// materials whose names Cryptomatte stores.
Metadata describe_picture(const View& view, const DisplayTransform& display, const std::optional<PictureError>& error,
                          const gpu::DeviceInfo& device, const std::string& scene_file, const Scene& named,
                          const AovSet& aovs);

}  // namespace promin::python
