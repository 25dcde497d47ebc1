// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/ndarray.h>

#include "promin/image.h"

namespace promin::python {

/// A linear picture: rows from the top, columns, R, G and B.
using PictureArray =
    nanobind::ndarray<const float, nanobind::shape<-1, -1, 3>, nanobind::c_contig, nanobind::device::cpu>;

/// The pixels, copied.
Image read_image_array(const PictureArray& pixels);
/// The pixels as an array of NumPy's that owns them.
nanobind::object write_image_array(Image image);

/// Any values as an array of NumPy's that owns them, of (rows, columns) and, where a value has several components,
/// those.
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
