// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests check how the programs show scenes far from the origin to a user: in world coordinates.

#include <fmt/format.h>

#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "cli_fixture.h"
#include "promin/math.h"

namespace promin {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// UTM coordinates, where the steps of fp32 are 0.03 and 0.5.
const dvec3 kPlace(494000.0, 5280000.0, 400.0);

/// Returns stairs of four steps around a place. They are as wide as they are deep.
std::string stairs_at(const dvec3& place) {
  std::string text;
  int count = 0;
  const auto add_face = [&](const dvec3& a, const dvec3& b) {
    for (const double x : {-2.0, 2.0}) {
      for (const dvec3& end : {a, b}) {
        text += fmt::format("v {:.4f} {:.4f} {:.4f}\n", place.x + x, place.y + end.y, place.z + end.z);
      }
    }
    text += fmt::format("f {} {} {} {}\n", count + 1, count + 3, count + 4, count + 2);
    count += 4;
  };
  for (int i = 0; i < 4; ++i) {
    const dvec3 low(0, 0.25 * i - 0.5, 1.0 - 0.5 * i);
    const dvec3 high = low + dvec3(0, 0.25, 0);
    add_face(low, high);
    add_face(high, high - dvec3(0, 0, 0.5));
  }
  return text;
}

std::string words_of(const dvec3& v) {
  return fmt::format("[{:.4f}, {:.4f}, {:.4f}]", v.x, v.y, v.z);
}

class FarCliTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("near.obj", stairs_at(dvec3(0.0)));
    write("far.obj", stairs_at(kPlace));
  }

  /// Returns the options of a view whose eye is at the place's (1, 2, 5).
  static OptionValues view_at(const dvec3& place) {
    const dvec3 eye = place + dvec3(1, 2, 5);
    return {"--size",
            "48",
            "36",
            "--eye",
            fmt::format("{:.4f}", eye.x),
            fmt::format("{:.4f}", eye.y),
            fmt::format("{:.4f}", eye.z),
            "--direction",
            "-0.2",
            "-0.4",
            "-1"};
  }

  template <typename Number>
  void write_ray(const std::string& file, const std::string& type, const std::vector<Number>& ray) const {
    const std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (1, 8), }\n";
    std::string bytes("\x93NUMPY\x01\0", 8);
    bytes += static_cast<char>(header.size());
    bytes += '\0';
    bytes += header;
    bytes.append(reinterpret_cast<const char*>(ray.data()), 8 * sizeof(Number));
    write(file, bytes);
  }

  std::string hits_of(const std::string& scene, const OptionValues& more = {}) const {
    OptionValues arguments = {"cast", scene, "rays.npy", "-o", "hits.npy", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProcessResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read("hits.npy");
  }
};

/// The view is given by a pose and by a camera path.
TEST_F(FarCliTest, PicturesAreThoseOfTheSameSceneAtTheOrigin) {
  OptionValues near = view_at(dvec3(0.0));
  near.insert(near.begin(), "near.obj");
  OptionValues far = view_at(kPlace);
  far.insert(far.begin(), "far.obj");
  const Image expected = render(near, "near.exr");
  EXPECT_EQ(render(far, "far.exr").pixels, expected.pixels);

  const auto path = [](const dvec3& place) {
    return R"({"format": "promin camera path", "version": 1, "fps": 10, "frames": [{"time_s": 0, "eye": )" +
           words_of(place + dvec3(1, 2, 5)) + R"(, "look": [-0.2, -0.4, -1], "up": [0, 1, 0], "fov_deg": 40},
             {"time_s": 0.2, "eye": )" +
           words_of(place + dvec3(2, 2, 5)) + R"(, "look": [-0.4, -0.4, -1], "up": [0, 1, 0], "fov_deg": 40}]})";
  };
  write("near.json", path(dvec3(0.0)));
  write("far.json", path(kPlace));
  for (const std::string name : {"near", "far"}) {
    const ProcessResult result = run({"render", name + ".obj", "--size", "48", "36", "--path", name + ".json",
                                      "--frames", "1-1", "-o", name + ".#.exr", "--quiet"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
  EXPECT_EQ(read_image(folder() / "far.1.exr").pixels, read_image(folder() / "near.1.exr").pixels);
  EXPECT_NE(read_image(folder() / "far.1.exr").pixels, expected.pixels);
}

TEST_F(FarCliTest, RaysOfDoublesAreInTheWorld) {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto ray_at = [&](const dvec3& p) {
    return std::vector<double>{p.x + 0.375, p.y + 0.125, p.z + 3.0, 0.0, 0.0, 0.0, -2.0, infinity};
  };
  write_ray("rays.npy", "<f8", ray_at(dvec3(0.0)));
  const std::string expected = hits_of("near.obj");
  const auto first = static_cast<float>(0.375);
  write_ray<float>("rays.npy", "<f4", {first, 0.125F, 3.0F, 0, 0, 0, -2, std::numeric_limits<float>::infinity()});
  EXPECT_EQ(hits_of("near.obj"), expected);
  write_ray("rays.npy", "<f8", ray_at(kPlace));
  EXPECT_EQ(hits_of("far.obj"), expected);
  // A job's pieces have the same hits.
  EXPECT_EQ(hits_of("far.obj", {"--job", "job", "--pieces", "1"}), expected);
  float t = 0.0F;
  std::memcpy(&t, expected.data() + expected.find('\n') + 1, sizeof(t));
  EXPECT_EQ(t, 1.5F) << "the riser at z = 0";
}

TEST_F(FarCliTest, WhatIsToldIsInTheWorld) {
  const ProcessResult info = run({"info", "far.obj"});
  EXPECT_THAT(info.out, HasSubstr("493998 5279999.5 399 to 494002 5280000.5 401"));
  EXPECT_THAT(info.out, HasSubstr("494000 5280000 400"));
  EXPECT_THAT(info.out, HasSubstr("degenerate: 0"));
  EXPECT_THAT(run({"info", "near.obj"}).out, Not(HasSubstr("center")));
  OptionValues arguments = view_at(kPlace);
  arguments.insert(arguments.begin(), {"render", "far.obj"});
  arguments.insert(arguments.end(), {"--explain", "24", "20"});
  const ProcessResult explained = run(arguments);
  ASSERT_EQ(explained.exit_code, 0) << explained.err;
  const json ray = json::parse(explained.out).at("samples")[0].at("rays")[0];
  EXPECT_EQ(ray.at("origin"), json({494001.0, 5280002.0, 405.0}));
  EXPECT_NEAR(ray.at("hit").at("position")[1].get<double>(), 5280000.0, 0.5);
}

}  // namespace
}  // namespace promin
