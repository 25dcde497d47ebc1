// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/load_report.h"
#include "promin/scene.h"

namespace promin {

/// Reads the report's file as STL, binary or text. A file whose size is what its count of facets asks for is binary,
/// whatever it begins with; one whose count of facets was never written has as many as there is room for. Each facet is
/// a triangle with corners of its own, in file order, drawn sharp: its normal in the file is ignored. Colours of facets
/// are those of VisCAM and SolidView, or of Magics, and taken for those of sRGB. A solid with facets is an object of
/// the default material, by its name; a binary file is one. Throws InputError with all problems.
Scene load_stl(const LoadOptions& options, LoadReport& report);

}  // namespace promin
