// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/ndarray.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "promin/math.h"

namespace promin::python {

using Matrix = nanobind::ndarray<const double, nanobind::shape<4, 4>, nanobind::c_contig, nanobind::device::cpu>;
using Matrices = nanobind::ndarray<const double, nanobind::shape<-1, 4, 4>, nanobind::c_contig, nanobind::device::cpu>;

/// Python stores matrices by rows, GLM by columns.
inline dmat4 read_matrix(const double* numbers) {
  dmat4 result;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) result[column][row] = numbers[4 * row + column];
  }
  return result;
}

/// Returns the transform of each of these objects.
inline std::vector<std::pair<uint32_t, dmat4>> read_transforms(const std::vector<uint32_t>& objects,
                                                               const Matrices& matrices) {
  std::vector<std::pair<uint32_t, dmat4>> transforms;
  for (size_t i = 0; i < objects.size() && i < matrices.shape(0); ++i) {
    transforms.emplace_back(objects[i], read_matrix(matrices.data() + 16 * i));
  }
  return transforms;
}

}  // namespace promin::python
