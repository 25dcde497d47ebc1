// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "reporting/session.h"

namespace promin::report {

/// A CSV file for each table of a report, SECTION.csv of its "rows" and SECTION_NAME.csv of others; each line carries
/// device, driver, compiler, commit and date as well. What a row lacks is empty. And runs.csv, a line for each timed
/// run of each time in their rows. Throws RunError.
void write_csv_files(const Json& report, const std::filesystem::path& folder);

/// Takes out of a report the single runs, which runs.csv has.
void drop_values(Json& json);

}  // namespace promin::report
