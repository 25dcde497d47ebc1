// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "hard/figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/file.h"

namespace promin::hard {
namespace {

using Json = nlohmann::ordered_json;

/// Returns a text instead of a number that is not finite, because JSON cannot express such numbers.
Json number_of(double figure) {
  if (std::isnan(figure)) return "nan";
  if (std::isinf(figure)) return figure > 0.0 ? "inf" : "-inf";
  return figure;
}

Json json_of(const RowFigure& row) {
  Json json = {{"row", row.row}, {"what", row.what}, {"figure", number_of(row.figure)}};
  if (row.bound) json["bound"] = *row.bound;
  return json;
}

Json json_of(const PrimitiveFigures& primitive) {
  const Tally& tally = primitive.tally;
  return {{"rays", tally.rays},
          {"judged", tally.judged},
          {"hits", tally.hits},
          {"max_k", number_of(tally.max_t_error)},
          {"rms_k", number_of(tally.rms_t_error())},
          {"max_surface_k", number_of(tally.max_surface_error)},
          {"misclassified", tally.misclassified},
          {"max_margin", number_of(tally.max_margin)},
          {"leaks", primitive.leaks}};
}

/// Returns the names of the tests that failed, such as "Row24_DegenerateTriangles".
Json list_failed() {
  Json names = Json::array();
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int j = 0; j < suite.total_test_count(); ++j) {
      const testing::TestInfo& test = *suite.GetTestInfo(j);
      const std::string name = test.name();
      if (test.result()->Failed()) names.push_back(name.substr(name.rfind('/') + 1));
    }
  }
  return names;
}

/// Writes the figures after all tests have run.
class FigureWriter : public testing::Environment {
 public:
  void TearDown() override {
    const char* file = std::getenv("PROMIN_FIGURES");
    if (file == nullptr) return;
    const gpu::DeviceInfo device = gpu::info_of(*gpu::open_device());
    Json json = {
        {"device", device.name}, {"driver", device.driver}, {"failed", list_failed()}, {"rows", Json::array()}};
    for (const RowFigure& row : figures().rows) json["rows"].push_back(json_of(row));
    for (const auto& [name, primitive] : figures().primitives) json["primitives"][name] = json_of(primitive);
    write_text_file(file, json.dump(1) + "\n");
  }
};

const testing::Environment* const kWriter = testing::AddGlobalTestEnvironment(new FigureWriter);

}  // namespace

Figures& figures() {
  static Figures all;
  return all;
}

}  // namespace promin::hard
