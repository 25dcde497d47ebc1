// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/report_command.h"
#include "run_program.h"

int main(int argc, char** argv) {
  using namespace promin;
  return app::run_program("promin-report",
                          "Measures speed against error on a device, for tools/report to make figures and a page of.",
                          {report::add_report_command}, argc, argv);
}
