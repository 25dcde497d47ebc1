// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "promin/explain.h"
#include "scene/features.h"

namespace promin {

struct PrimitiveNumbers;

namespace gpu {
class Device;
}
class DeviceScene;
struct View;

/// Traces a pixel of the view's picture with the picture's own shaders, which write a log (FEATURE_RAY_LOG), and waits
/// for the device. `features` are the scene's features; the view's crop and debug view are ignored. Throws
/// vk::SystemError, and RunError if the log might be too long.
Explanation explain_pixel(const gpu::Device& device, const std::shared_ptr<const DeviceScene>& scene,
                          const PrimitiveNumbers& numbers, FeatureMask features, const View& view, const uvec2& pixel);

}  // namespace promin
