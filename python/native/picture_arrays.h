// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/ndarray.h>

#include "promin/image.h"

namespace promin::python {

/// A linear picture with the shape (rows, columns, 3): rows from the top, then R, G and B.
using PictureArray =
    nanobind::ndarray<const float, nanobind::shape<-1, -1, 3>, nanobind::c_contig, nanobind::device::cpu>;

/// Returns a copy of the pixels as an Image.
Image read_image_array(const PictureArray& pixels);
/// Returns the pixels as a NumPy array that owns them.
nanobind::object write_image_array(Image image);

/// Returns values as a NumPy array that owns them. Its shape is (rows, columns), or (rows, columns, components) if a
/// value has several components.
template <typename Component, typename Value>
nanobind::object write_array(std::vector<Value> values, const uvec2& size) {
  constexpr size_t kComponents = sizeof(Value) / sizeof(Component);
  auto* owned = new std::vector<Value>(std::move(values));
  const nanobind::capsule owner(owned, [](void* data) noexcept { delete static_cast<std::vector<Value>*>(data); });
  const size_t shape[3] = {size.y, size.x, kComponents};
  return nanobind::cast(
      nanobind::ndarray<nanobind::numpy, Component>(owned->data(), kComponents == 1 ? 2 : 3, shape, owner));
}

}  // namespace promin::python
