// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "work/spec/cast_spec.h"
#include "work/spec/render_spec.h"
#include "work/spec/spec_values.h"

// The table of the members of specifications: their names, places, types, ranges and defaults.
namespace promin::work::fields {

/// Properties of a member that matter for jobs and command lines.
struct Traits {
  /// A value that has the same effect as leaving the member out.
  Json usual = {};
  bool affects_bits = true;
  bool is_file = false;
  /// True if pieces depend on the member; false for members that are chosen when pieces are merged.
  bool is_of_pieces = true;
  /// The members that this member replaces if it is given in addition to a specification.
  std::vector<std::string_view> replaces = {};
};

/// A member of a specification.
template <typename Spec>
struct Field {
  /// The name in JSON. The option's name has - in place of _.
  std::string name;
  Traits traits;
  /// Returns the member's value as JSON; null for the default value.
  std::function<Json(const Spec&)> write;
  std::function<void(const Json&, Spec&)> read;
  std::function<void(Spec&)> reset;
};

/// Returns all members in the order in which they are written. The template exists for RenderSpec and CastSpec.
template <typename Spec>
const std::vector<Field<Spec>>& fields_of();

}  // namespace promin::work::fields
