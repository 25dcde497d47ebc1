// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "hard/figures.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "core/file.h"

namespace promin::hard {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const RowFigure& row) {
  Json json = {{"row", row.row}, {"what", row.what}, {"figure", row.figure}};
  if (row.bound) json["bound"] = *row.bound;
  return json;
}

Json json_of(const PrimitiveFigures& primitive) {
  const Tally& tally = primitive.tally;
  return {{"rays", tally.rays},
          {"hits", tally.hits},
          {"max_k", tally.max_t_error},
          {"rms_k", tally.rms_t_error()},
          {"max_surface_k", tally.max_surface_error},
          {"misclassified", tally.misclassified},
          {"max_margin", tally.max_margin},
          {"leaks", primitive.leaks}};
}

/// Writes the figures when all tests have run.
class FigureWriter : public testing::Environment {
 public:
  void TearDown() override {
    const char* file = std::getenv("PROMIN_FIGURES");
    if (file == nullptr) return;
    const gpu::DeviceInfo device = gpu::info_of(*gpu::open_device());
    Json json = {{"device", device.name}, {"driver", device.driver}, {"rows", Json::array()}};
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
