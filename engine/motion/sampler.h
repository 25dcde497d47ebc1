// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "promin/motion.h"

namespace promin {

/// Returns the number of numbers that a sampler stores for each component of each key: 3 for splines, otherwise 1.
size_t numbers_per_component(Interpolation interpolation);

/// Returns a quaternion of length 1; the identity for a quaternion of length 0.
dvec4 to_unit_quaternion(const dvec4& quaternion);

/// Returns the rotation between two unit quaternions that lies at the fraction `fraction` of the shorter arc.
dvec4 slerp(const dvec4& from, const dvec4& to, double fraction);

/// Computes the value of a valid sampler at a time (glTF 2.0, appendix C). `value` has one number for each component.
/// With `is_rotation`, values are quaternions, and the result is a unit quaternion.
void sample(const AnimationSampler& sampler, double time_s, bool is_rotation, std::span<double> value);

}  // namespace promin
