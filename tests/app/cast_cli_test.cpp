// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests run `promin cast` as a user does.

#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli_fixture.h"
#include "promin/ray.h"
#include "support/moving_gltf.h"

namespace promin {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

class CastTest : public CliTest {
 protected:
  std::vector<Hit> read_hits(const std::string& file) const {
    const std::string bytes = read(file);
    const size_t header = bytes.find('\n') + 1;
    std::vector<Hit> hits((bytes.size() - header) / sizeof(Hit));
    std::memcpy(hits.data(), bytes.data() + header, hits.size() * sizeof(Hit));
    return hits;
  }
  template <typename T>
  std::vector<T> read_array(const std::string& file) const {
    const std::string bytes = read(file);
    const size_t header = bytes.find('\n') + 1;
    std::vector<T> numbers((bytes.size() - header) / sizeof(T));
    std::memcpy(numbers.data(), bytes.data() + header, numbers.size() * sizeof(T));
    return numbers;
  }
};

/// The rays go to the square at z = 0 from z = 4: a hit, a miss beside it, and one that ends at tmax before it.
const std::vector<Ray> kRays = {{vec3(0.5F, 0.25F, 4), 0, vec3(0, 0, -2), kInfinity},
                                {vec3(5, 0, 4), 0, vec3(0, 0, -2), kInfinity},
                                {vec3(0.5F, 0.25F, 4), 0, vec3(0, 0, -2), 2}};

TEST_F(CastTest, AnswersRays) {
  write_rays("rays.npy", kRays);
  const ProcessResult result = run({"cast", "square.gltf", "rays.npy", "-o", "hits.npy"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, testing::MatchesRegex("3 rays in .* hits.npy\n"));
  const std::vector<Hit> hits = read_hits("hits.npy");
  ASSERT_EQ(hits.size(), 3U);
  EXPECT_EQ(hits[0].t, 2.0F);
  EXPECT_EQ(hits[0].object, 0);
  EXPECT_EQ(hits[0].primitive, 0);
  EXPECT_NEAR(hits[0].u, 0.125F, 1e-6F);  // weight of the second corner, (1, -1)
  EXPECT_NEAR(hits[0].v, 0.625F, 1e-6F);  // weight of the third corner, (1, 1)
  EXPECT_EQ(hits[0].normal, vec3(0, 0, 1));
  for (const Hit& miss : {hits[1], hits[2]}) {
    EXPECT_EQ(miss.t, kInfinity);
    EXPECT_EQ(miss.object, -1);
    EXPECT_EQ(miss.primitive, -1);
    EXPECT_EQ(miss.u, 0.0F);
    EXPECT_EQ(miss.v, 0.0F);
    EXPECT_EQ(miss.normal, vec3(0));
  }
  EXPECT_THAT(files(), ElementsAre("hits.npy", "rays.npy"));
}

/// The scene has more identical faces than the number of turns after which a driver ends loops.
TEST_F(CastTest, ThePoseMovesTheHits) {
  GltfBuilder gltf = triangle_gltf();
  test::animate(gltf, 0, "/nodes/0/translation", {0, 2}, {0, 0, 0, 0, 0, 2}, "VEC3");
  test::animate(gltf, 1, "/nodes/0/scale", {0, 2}, {1, 1, 1, 3, 3, 1}, "VEC3");
  gltf.json["animations"][1]["name"] = "grow";
  write("move.gltf", gltf.text());
  write_rays("rays.npy", {{vec3(0.25F, 0.25F, 4), 0, vec3(0, 0, -1), kInfinity},
                          {vec3(1.5F, 0.25F, 4), 0, vec3(0, 0, -1), kInfinity}});
  const auto expect_hits = [&](const OptionValues& words, float first, float second) {
    OptionValues all = {"cast", "move.gltf", "rays.npy", "-o", "hits.npy"};
    all.insert(all.end(), words.begin(), words.end());
    const ProcessResult result = run(all);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_FLOAT_EQ(read_hits("hits.npy").at(0).t, first) << testing::PrintToString(words);
    EXPECT_FLOAT_EQ(read_hits("hits.npy").at(1).t, second) << testing::PrintToString(words);
  };
  expect_hits({}, 4.0F, kInfinity);
  expect_hits({"--time", "1"}, 3.0F, kInfinity);
  expect_hits({"--time", "5"}, 2.0F, kInfinity);
  expect_hits({"--time", "5", "--loop"}, 3.0F, kInfinity);
  expect_hits({"--animation", "grow", "--time", "2"}, 4.0F, 4.0F);
  expect_hits({"--animation", "0", "1", "--time", "2"}, 2.0F, 2.0F);
  expect_hits({"--animation", "all", "--time", "2"}, 2.0F, 2.0F);
  expect_hits({"--animation", "none", "--time", "2"}, 4.0F, kInfinity);
}

TEST_F(CastTest, AnyNumberOfIdenticalFacesIsTraced) {
  constexpr uint32_t kCount = 70'000;
  std::string text = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv -1 -1 -1\nv 1 -1 -1\nv 0 1 -1\nf 4 5 6\n";
  for (uint32_t i = 0; i < kCount; ++i) text += "f 1 2 3\n";
  write("copies.obj", text);
  write_rays("rays.npy",
             {{vec3(0, 0, 4), 0, vec3(0, 0, -1), kInfinity}, {vec3(9, 0, 4), 0, vec3(0, 0, -1), kInfinity}});
  const auto cast = [&](const OptionValues& more) {
    OptionValues arguments = {"cast", "copies.obj", "rays.npy", "--quiet", "-o", "answers.npy"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProcessResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  cast({});
  EXPECT_EQ(read_hits("answers.npy")[0].primitive, 1) << "the first of them";
  EXPECT_EQ(read_hits("answers.npy")[0].t, 4.0F);
  cast({"--any"});
  EXPECT_EQ(read_hits("answers.npy")[0].t, 0.0F);
  cast({"--count"});
  EXPECT_THAT(read_array<int32_t>("answers.npy"), ElementsAre(kCount + 1, 0));
  cast({"--all", "--offsets", "offsets.npy"});
  EXPECT_THAT(read_array<uint64_t>("offsets.npy"), ElementsAre(0U, kCount + 1, kCount + 1));
  const std::vector<Hit> hits = read_hits("answers.npy");
  ASSERT_EQ(hits.size(), kCount + 1);
  for (uint32_t i = 0; i < kCount; ++i) ASSERT_EQ(hits[i].primitive, static_cast<int32_t>(i + 1));
  EXPECT_EQ(hits.back().primitive, 0);
  EXPECT_EQ(hits.back().t, 5.0F);
  const Image picture = render({"copies.obj", "--size", "16", "12", "-s", "1"}, "copies.exr");
  EXPECT_NE(picture.at(8, 6), picture.at(0, 0));
}

TEST_F(CastTest, EachSphereIsAnObject) {
  // Each sphere is an object of its own, although they share a material.
  write("three.nff", "f 1 1 1 1 0 0 0 0 s 0 0 0 1 s 5 0 0 1 f 1 0 0 1 0 0 0 0 f 1 0 0 1 0 0 0 0 s 10 0 0 1");
  std::vector<Ray> rays;
  for (const float x : {0.0F, 5.0F, 10.0F, 15.0F}) rays.push_back({vec3(x, 0, 4), 0, vec3(0, 0, -1), kInfinity});
  write_rays("rays.npy", rays);
  const ProcessResult result = run({"cast", "three.nff", "rays.npy", "-o", "hits.npy", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::vector<int32_t> objects;
  for (const Hit& hit : read_hits("hits.npy")) objects.push_back(hit.object);
  EXPECT_THAT(objects, ElementsAre(0, 1, 2, -1));
}

TEST_F(CastTest, RaysThatCannotHitAreCounted) {
  std::vector<Ray> rays = kRays;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  rays.push_back({vec3(0, 0, 4), 0, vec3(0, 0, 0), kInfinity});
  rays.push_back({vec3(0, 0, 4), 0, vec3(0, 0, -1), 0});
  rays.push_back({vec3(0, 0, 4), -1, vec3(0, 0, -1), -0.5F});
  rays.push_back({vec3(0, nan, 4), 0, vec3(0, 0, -1), kInfinity});
  rays.push_back({vec3(0, 0, 4), nan, vec3(0, 0, -1), kInfinity});
  rays.push_back({vec3(0, 0, 4), -kInfinity, vec3(0, 0, -1), kInfinity});
  write_rays("rays.npy", rays);
  const ProcessResult result = run({"cast", "square.gltf", "rays.npy", "-o", "hits.npy"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err,
            "promin: warning: 5 of 9 rays cannot hit anything; the first of them is number 3; a ray needs a direction "
            "that is not 0, tmin < tmax and no NaN\n");
  const std::vector<Hit> hits = read_hits("hits.npy");
  for (size_t i = 3; i < 8; ++i) EXPECT_EQ(hits[i].object, -1) << i;
  EXPECT_EQ(hits[8].object, 0);
}

TEST_F(CastTest, AnyTellsOnlyWhether) {
  write_rays("rays.npy", kRays);
  ASSERT_EQ(run({"cast", "square.gltf", "rays.npy", "-o", "hits.npy", "--any", "--quiet"}).exit_code, 0);
  const std::vector<Hit> hits = read_hits("hits.npy");
  ASSERT_EQ(hits.size(), 3U);
  EXPECT_EQ(hits[0].t, 0.0F);
  EXPECT_EQ(hits[1].t, kInfinity);
  EXPECT_EQ(hits[2].t, kInfinity);
  for (const Hit& hit : hits) {
    EXPECT_EQ(hit.object, -1);
    EXPECT_EQ(hit.primitive, -1);
    EXPECT_EQ(hit.normal, vec3(0));
  }
}

/// Returns the rays of kRays and one along the other diagonal of the square, through the common edge of both triangles.
std::vector<Ray> rays_to_count() {
  std::vector<Ray> rays = kRays;
  rays.push_back({vec3(0, 0, 4), 0, vec3(0, 0, -2), kInfinity});
  return rays;
}

TEST_F(CastTest, CountTellsHowOften) {
  write_rays("rays.npy", rays_to_count());
  const ProcessResult result =
      run({"cast", "square.gltf", "rays.npy", "-o", "counts.npy", "--count", "--stats", "s.json", "--repeat", "2"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, testing::MatchesRegex("4 rays in .* counts.npy\n"));
  EXPECT_THAT(read("counts.npy"), HasSubstr("'<i4', 'fortran_order': False, 'shape': (4,)"));
  EXPECT_THAT(read_array<int32_t>("counts.npy"), ElementsAre(1, 0, 0, 1));
  const json stats = json::parse(read("s.json"));
  EXPECT_EQ(stats.at("rays").at("primary"), 4);
  EXPECT_EQ(stats.at("trace_runs_ms").size(), 2U);
}

TEST_F(CastTest, AllTellsEveryHit) {
  // The scene is that of ObjectsHaveTheFilesNumbers. One ray goes through all three spheres, one beside them, one
  // through the last.
  write("three.nff", "f 1 1 1 1 0 0 0 0 s 0 0 0 1 s 5 0 0 1 f 1 0 0 1 0 0 0 0 f 1 0 0 1 0 0 0 0 s 10 0 0 1");
  write_rays("rays.npy", {{vec3(-4, 0, 0), 0, vec3(2, 0, 0), kInfinity},
                          {vec3(-4, 3, 0), 0, vec3(1, 0, 0), kInfinity},
                          {vec3(10, 0, 4), 0, vec3(0, 0, -1), kInfinity}});
  const ProcessResult result = run({"cast", "three.nff", "rays.npy", "-o", "hits.npy", "--all", "--offsets", "o.npy",
                                    "--repeat", "2", "--stats", "s.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, testing::MatchesRegex("3 rays, 8 hits in .* hits.npy, o.npy\n"));
  EXPECT_THAT(read_array<uint64_t>("o.npy"), ElementsAre(0, 6, 6, 8));
  std::vector<float> ts;
  std::vector<int32_t> objects;
  for (const Hit& hit : read_hits("hits.npy")) {
    ts.push_back(hit.t);
    objects.push_back(hit.object);
  }
  EXPECT_THAT(ts, ElementsAre(1.5F, 2.5F, 4, 5, 6.5F, 7.5F, 3, 5));
  EXPECT_THAT(objects, ElementsAre(0, 0, 1, 1, 2, 2, 2, 2));
  EXPECT_EQ(json::parse(read("s.json")).at("rays").at("primary"), 3);
  EXPECT_THAT(files(), ElementsAre("hits.npy", "o.npy", "rays.npy", "s.json", "three.nff"));
}

TEST_F(CastTest, NoRaysHaveNoCountsAndOneOffset) {
  write_rays("rays.npy", {});
  ASSERT_EQ(run({"cast", "square.gltf", "rays.npy", "-o", "c.npy", "--count", "--quiet"}).exit_code, 0);
  EXPECT_THAT(read_array<int32_t>("c.npy"), IsEmpty());
  ASSERT_EQ(run({"cast", "square.gltf", "rays.npy", "-o", "h.npy", "--all", "--offsets", "o.npy"}).exit_code, 0);
  EXPECT_THAT(read_hits("h.npy"), IsEmpty());
  EXPECT_THAT(read_array<uint64_t>("o.npy"), ElementsAre(0));
}

// There are more rays than a chunk holds, more hits than a list holds, and any number of driver threads.
TEST_F(CastTest, CountsAndListsOfManyRays) {
  std::vector<Ray> rays((size_t{1} << 20) + 1000, kRays[0]);
  for (size_t i = 0; i < rays.size(); ++i) rays[i].origin.x = i % 3 == 0 ? 2.0F : 0.25F;
  write_rays("rays.npy", rays);
  // The scene has the triangle five times.
  std::string obj = kTriangleObj;
  for (int i = 0; i < 4; ++i) obj += "f 1 2 3\n";
  write("five.obj", obj);
  ASSERT_EQ(run({"cast", "five.obj", "rays.npy", "-o", "c.npy", "--count", "--quiet"}).exit_code, 0);
  ASSERT_EQ(run({"cast", "five.obj", "rays.npy", "-o", "h.npy", "--all", "--offsets", "o.npy", "--quiet"}).exit_code,
            0);
  const std::vector<int32_t> counts = read_array<int32_t>("c.npy");
  const std::vector<uint64_t> offsets = read_array<uint64_t>("o.npy");
  const std::vector<Hit> hits = read_hits("h.npy");
  ASSERT_EQ(offsets.size(), rays.size() + 1);
  ASSERT_EQ(offsets.back(), hits.size());
  size_t wrong = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    wrong += counts[i] != (i % 3 == 0 ? 0 : 5) || offsets[i + 1] - offsets[i] != static_cast<uint64_t>(counts[i]);
    for (uint64_t k = offsets[i]; k < offsets[i + 1]; ++k)
      wrong += hits[k].primitive != static_cast<int>(k - offsets[i]);
  }
  EXPECT_EQ(wrong, 0U);
  options_.environment["LP_NUM_THREADS"] = "1";
  ASSERT_EQ(run({"cast", "five.obj", "rays.npy", "-o", "h1.npy", "--all", "--offsets", "o1.npy", "--quiet"}).exit_code,
            0);
  EXPECT_EQ(read("h1.npy"), read("h.npy"));
  EXPECT_EQ(read("o1.npy"), read("o.npy"));
}

TEST_F(CastTest, NoRaysAreNoHits) {
  write_rays("rays.npy", {});
  const ProcessResult result = run({"cast", "triangle.obj", "rays.npy", "-o", "hits.npy", "--stats", "s.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(read_hits("hits.npy"), IsEmpty());
  EXPECT_EQ(json::parse(read("s.json")).at("rays").at("primary"), 0);
}

TEST_F(CastTest, MoreRaysThanAChunkHolds) {
  // A row of rays crosses the square's edge at x = 1; a chunk has 2^20 rays.
  std::vector<Ray> rays((size_t{1} << 20) + 1000, kRays[0]);
  for (size_t i = 0; i < rays.size(); ++i) rays[i].origin.x = i % 3 == 0 ? 2.0F : 0.5F;
  write_rays("rays.npy", rays);
  ASSERT_EQ(run({"cast", "square.gltf", "rays.npy", "-o", "hits.npy", "--quiet", "--repeat", "2"}).exit_code, 0);
  const std::vector<Hit> hits = read_hits("hits.npy");
  ASSERT_EQ(hits.size(), rays.size());
  for (size_t i = 0; i < hits.size(); ++i) ASSERT_EQ(hits[i].object, i % 3 == 0 ? -1 : 0) << i;
}

TEST_F(CastTest, StatsHoldWhatThoseOfAPictureHold) {
  write_rays("rays.npy", kRays);
  ASSERT_EQ(run({"cast", "square.gltf", "rays.npy", "-o", "h.npy", "--stats", "s.json", "--repeat", "3", "--builder",
                 "median", "--quiet"})
                .exit_code,
            0);
  const json stats = json::parse(read("s.json"));
  EXPECT_EQ(stats.at("bvh").at("builder"), "median");
  EXPECT_EQ(stats.at("rays").at("primary"), 3);
  EXPECT_EQ(stats.at("trace_runs_ms").size(), 3U);
  for (const char* name : {"load", "bvh", "upload", "pipeline", "trace", "write", "total"}) {
    EXPECT_GE(stats.at("times_ms").at(name), 0.0) << name;
  }
  EXPECT_FALSE(stats.contains("view"));
}

TEST_F(CastTest, WrongUseAndBadFilesAreRefused) {
  write_rays("rays.npy", kRays);
  expect_failure(run({"cast", "square.gltf", "rays.npy"}), 2, "--output");
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "hits.csv"}), 2, "output.extension .npy");
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "rays.npy"}), 2, "output.input");
  expect_failure(run({"cast", "square.gltf", "-o", "hits.npy"}), 2, "RAYS.npy");
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "a.npy", "-o", "b.npy"}), 2, "takes only one file");
  expect_failure(run({"cast", "square.gltf", "none.npy", "-o", "hits.npy"}), 3, "none.npy");
  expect_failure(run({"cast", "square.gltf", "square.gltf", "-o", "hits.npy"}), 3, "rays.kind");
  expect_failure(run({"cast", "none.obj", "rays.npy", "-o", "hits.npy"}), 3, "none.obj");
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "none/hits.npy"}), 1, "folder");
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "hits.npy", "--device", "none"}), 4, "none");
  const auto refused = [&](const OptionValues& options, const std::string& part, int exit_code = 2) {
    OptionValues arguments = {"cast", "square.gltf", "rays.npy", "-o", "hits.npy"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    expect_failure(run(arguments), exit_code, part);
  };
  refused({"--any", "--count"}, "usage.options.contradict --any --count");
  refused({"--any", "--all", "--offsets", "o.npy"}, "usage.options.contradict --any --all");
  refused({"--count", "--all", "--offsets", "o.npy"}, "usage.options.contradict --count --all");
  refused({"--all"}, "--offsets");
  refused({"--offsets", "o.npy"}, "--all");
  refused({"--count", "--offsets", "o.npy"}, "--all");
  refused({"--all", "--offsets", "o.csv"}, "output.extension .npy");
  refused({"--all", "--offsets", "hits.npy"}, "output.twice");
  refused({"--all", "--offsets", "rays.npy"}, "output.input");
  refused({"--all", "--offsets", "none/o.npy"}, "folder", 1);
  EXPECT_THAT(files(), ElementsAre("rays.npy"));
  write("made.obj", "mtllib made.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("made.mtl", "newmtl m\n");
  expect_failure(run({"cast", "made.obj", "rays.npy", "-o", "hits.npy", "--stats", "made.mtl"}), 2,
                 "output.input made.mtl:");
}

TEST_F(CastTest, AFullDiskLeavesTheOldFile) {
  write_rays("rays.npy", std::vector<Ray>(4000, kRays[0]));
  write("hits.npy", "old");
  fill_disk(100'000);
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "hits.npy"}), 1, "the output file cannot be written");
  EXPECT_EQ(read("hits.npy"), "old");
  EXPECT_THAT(files(), ElementsAre("hits.npy", "rays.npy"));
}

TEST_F(CastTest, AFullDiskLeavesBothOldFiles) {
  write_rays("rays.npy", std::vector<Ray>(4000, kRays[0]));
  write("hits.npy", "old hits");
  write("o.npy", "old offsets");
  // The disk has room for the offsets, but not for the hits.
  fill_disk(100'000);
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "hits.npy", "--all", "--offsets", "o.npy"}), 1,
                 "the output file cannot be written");
  EXPECT_EQ(read("hits.npy"), "old hits");
  EXPECT_EQ(read("o.npy"), "old offsets");
  EXPECT_THAT(files(), ElementsAre("hits.npy", "o.npy", "rays.npy"));
}

TEST_F(CastTest, AnInterruptLeavesNeitherOfTwoFiles) {
  write_rays("rays.npy", std::vector<Ray>(1000, kRays[0]));
  write("o.npy", "old");
  for (const int delay_ms : {100, 1000}) {
    Process program(PROMIN_EXECUTABLE,
                    {"cast", "square.gltf", "rays.npy", "-o", "hits.npy", "--all", "--offsets", "o.npy", "--repeat",
                     "10000", "--quiet"},
                    options_);
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
    program.send(SIGINT);
    const ProcessResult result = program.wait();
    EXPECT_EQ(result.signal, SIGINT) << result.err;
    EXPECT_EQ(read("o.npy"), "old");
    EXPECT_THAT(files(), ElementsAre("o.npy", "rays.npy"));
  }
}

TEST_F(CastTest, AnInterruptLeavesNoPartialFile) {
  write_rays("rays.npy", std::vector<Ray>(1000, kRays[0]));
  write("hits.npy", "old");
  for (const int delay_ms : {100, 900, 1500}) {
    Process program(PROMIN_EXECUTABLE,
                    {"cast", "square.gltf", "rays.npy", "-o", "hits.npy", "--repeat", "10000", "--quiet"}, options_);
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
    program.send(SIGINT);
    const ProcessResult result = program.wait();
    EXPECT_EQ(result.signal, SIGINT) << result.err;
    EXPECT_EQ(read("hits.npy"), "old");
    EXPECT_THAT(files(), ElementsAre("hits.npy", "rays.npy"));
  }
}

}  // namespace
}  // namespace promin
