// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "reporting/session.h"

namespace promin::report {

/// Of runs.json and report.json; another where a reader of the last one would be misled.
inline constexpr int kReportFormat = 3;

/// What every figure stands under: device, driver, compiler, commit, date, runs, and how busy the machine was before.
Json describe_run(const Session& session);

/// How busy it was after, and how long the report took.
void end_run(Json& report);

}  // namespace promin::report
