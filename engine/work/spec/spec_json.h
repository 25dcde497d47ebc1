// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "work/spec/cast_spec.h"
#include "work/spec/render_spec.h"

// Specifications as JSON: an object whose member "promin_render_spec" or "promin_cast_spec" is 1. Its other members
// have the names of the programs' options, with _ in place of -. One table of fields (spec_fields.cpp) gives each
// member its name, place, type, range and default, and states whether it affects bits and whether it names files.
//
// The templates exist for RenderSpec and CastSpec.
namespace promin::work {

/// A file name that stands for the standard input.
inline constexpr std::string_view kStandardInput = "-";

/// Reads a specification. Files that it names are relative to its own folder, or to the current folder if it comes from
/// the standard input. Members that each process chooses keep their defaults. check_spec.h checks whether members
/// contradict each other. Throws InputError with all problems.
template <typename Spec>
Spec read_spec(const std::filesystem::path& file);
/// Reads a specification from the text of a file.
template <typename Spec>
Spec parse_spec(std::string_view text, const std::filesystem::path& file);

/// Returns the canonical text: members in the order of the table, without those that have their default value, and with
/// absolute paths. Reading the text gives a specification that has the same text. Throws UsageError for a path that is
/// not UTF-8.
template <typename Spec>
std::string write_spec(const Spec& spec);

/// Returns the canonical text without the outputs. The pieces of a job do not depend on outputs, which are chosen when
/// pieces are merged.
template <typename Spec>
std::string write_spec_of_pieces(const Spec& spec);

/// Returns the members that affect bits and do not have their default value, with the names of their options and with
/// values as on a command line. A file is represented by its name without its folder; the caller adds its hash.
template <typename Spec>
std::vector<std::pair<std::string, std::string>> list_bits(const Spec& spec);

/// Returns the option that sets a member: "--filter-width" for "filter_width".
std::string option_of(std::string member);

/// Resets the members that the option of this name replaces. An option replaces members if it is given in addition to a
/// specification: "--spp" replaces --quality and others.
template <typename Spec>
void clear_rivals(Spec& spec, std::string_view option);

}  // namespace promin::work
