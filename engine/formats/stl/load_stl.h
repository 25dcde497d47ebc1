// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/load_report.h"
#include "promin/scene.h"

namespace promin {

/// Reads the report's file as STL, binary or text. A file whose size matches its number of facets is binary, whatever
/// its first bytes are. If the number of facets was never written, all facets in the file are read. Each facet is a
/// flat-shaded triangle with its own corners, in file order; its normal in the file is ignored. Colours of facets, in
/// the form of VisCAM and SolidView or of Magics, are assumed to be sRGB. Each named solid with facets becomes an
/// object with the default material; a binary file is one object. Throws InputError with all problems.
Scene load_stl(const LoadOptions& options, LoadReport& report);

}  // namespace promin
