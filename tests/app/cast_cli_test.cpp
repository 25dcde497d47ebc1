// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// `promin cast` as a user runs it.

#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli_fixture.h"
#include "promin/ray.h"

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
};

/// Of the square at z = 0 seen from z = 4: a hit, a miss beside it, one cut off by tmax.
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
  EXPECT_NEAR(hits[0].v, 0.625F, 1e-6F);  // of the third, (1, 1)
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

TEST_F(CastTest, ObjectsHaveTheFilesNumbers) {
  // Each f with shapes is an object of the file: three spheres are objects 0, 0 and 1.
  write("three.nff", "f 1 1 1 1 0 0 0 0 s 0 0 0 1 s 5 0 0 1 f 1 0 0 1 0 0 0 0 f 1 0 0 1 0 0 0 0 s 10 0 0 1");
  std::vector<Ray> rays;
  for (const float x : {0.0F, 5.0F, 10.0F, 15.0F}) rays.push_back({vec3(x, 0, 4), 0, vec3(0, 0, -1), kInfinity});
  write_rays("rays.npy", rays);
  const ProcessResult result = run({"cast", "three.nff", "rays.npy", "-o", "hits.npy", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::vector<int32_t> objects;
  for (const Hit& hit : read_hits("hits.npy")) objects.push_back(hit.object);
  EXPECT_THAT(objects, ElementsAre(0, 0, 1, -1));
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

TEST_F(CastTest, NoRaysAreNoHits) {
  write_rays("rays.npy", {});
  const ProcessResult result = run({"cast", "triangle.obj", "rays.npy", "-o", "hits.npy", "--stats", "s.json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(read_hits("hits.npy"), IsEmpty());
  EXPECT_EQ(json::parse(read("s.json")).at("rays").at("primary"), 0);
}

TEST_F(CastTest, MoreRaysThanAChunkHolds) {
  // A row of rays across the square's edge at x = 1; 2^20 a chunk.
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
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "hits.csv"}), 2, "use .npy");
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "rays.npy"}), 2, "overwrite an input");
  expect_failure(run({"cast", "square.gltf", "-o", "hits.npy"}), 2, "RAYS.npy");
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "a.npy", "-o", "b.npy"}), 2, "takes one file");
  expect_failure(run({"cast", "square.gltf", "none.npy", "-o", "hits.npy"}), 3, "none.npy");
  expect_failure(run({"cast", "square.gltf", "square.gltf", "-o", "hits.npy"}), 3, "not a NumPy array");
  expect_failure(run({"cast", "none.obj", "rays.npy", "-o", "hits.npy"}), 3, "none.obj");
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "none/hits.npy"}), 1, "folder");
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "hits.npy", "--device", "none"}), 4, "none");
  EXPECT_THAT(files(), ElementsAre("rays.npy"));
}

TEST_F(CastTest, AFullDiskLeavesTheOldFile) {
  write_rays("rays.npy", std::vector<Ray>(4000, kRays[0]));
  write("hits.npy", "old");
  fill_disk(100'000);
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "hits.npy"}), 1, "cannot write the output file");
  EXPECT_EQ(read("hits.npy"), "old");
  EXPECT_THAT(files(), ElementsAre("hits.npy", "rays.npy"));
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
