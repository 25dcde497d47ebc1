// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/image.h"

namespace promin {

/// Returns LDR-FLIP of each pixel, 0...1 (Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG
/// 2020), for two pictures of the same size in linear light of 0...1. Other values are clamped, and NaN counts as 0.
std::vector<float> flip_map(const Image& reference, const Image& test, double pixels_per_degree);

}  // namespace promin
