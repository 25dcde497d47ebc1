// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <string>

#include "core/file.h"
#include "gpu/device_fixture.h"
#include "hard/hard_case.h"

namespace promin::hard {
namespace {

std::vector<HardCase> all_cases() {
  std::vector<HardCase> cases;
  for (const auto rows :
       {sphere_cases(), plane_cases(), solid_cases(), triangle_cases(), box_cases(), ray_cases(), secondary_cases(),
        host_cases(), tree_cases(), implicit_cases(), glass_cases(), instance_cases(), light_cases()}) {
    cases.insert(cases.end(), rows.begin(), rows.end());
  }
  std::sort(cases.begin(), cases.end(), [](const HardCase& a, const HardCase& b) { return a.row < b.row; });
  return cases;
}

class HardCaseTest : public test::DeviceTest, public testing::WithParamInterface<HardCase> {};

TEST_P(HardCaseTest, MeetsItsBound) {
  Lab lab(device(), GetParam().row);
  GetParam().run(lab);
}

INSTANTIATE_TEST_SUITE_P(Rows, HardCaseTest, testing::ValuesIn(all_cases()), [](const auto& param_info) {
  const int row = param_info.param.row;
  return (row < 10 ? "Row0" : "Row") + std::to_string(row) + "_" + param_info.param.name;
});

TEST(HardCases, AreNumberedInOrder) {
  const std::vector<HardCase> cases = all_cases();
  ASSERT_FALSE(cases.empty());
  for (size_t i = 0; i < cases.size(); ++i) EXPECT_EQ(cases[i].row, static_cast<int>(i) + 1);
}

// tools/accuracy makes the document. Nothing else reminds a developer to run it, so this test checks the document.
TEST(HardCases, AreAllInTheDocument) {
  const std::vector<std::byte> bytes = read_file(PROMIN_ACCURACY_DOCUMENT);
  const std::string document(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const HardCase& row : all_cases()) {
    EXPECT_NE(document.find("\n| " + std::to_string(row.row) + " | "), std::string::npos)
        << "docs/accuracy.md has no row " << row.row << "; run tools/accuracy";
  }
  // All figures are from one commit that exists in the repository.
  const std::regex head("\nMeasured at commit [0-9a-f]+ on ");
  EXPECT_TRUE(std::regex_search(document, head)) << "docs/accuracy.md is of several commits or of changes beside one";
}

}  // namespace
}  // namespace promin::hard
