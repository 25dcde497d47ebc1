// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check the version of results (engine/work/jobs/results_version.h), on which jobs depend. It must be
// raised if the stored pictures or the casts of three scenes change. results.txt has their hashes, and the version at
// which they were recorded. PROMIN_UPDATE_GOLDENS=1, which tools/update_goldens sets, writes that file.
#include "work/jobs/results_version.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "core/file.h"
#include "gpu/device_fixture.h"
#include "jobs/sha256.h"
#include "promin/caster.h"
#include "promin/image.h"
#include "promin/load_scene.h"

namespace promin {
namespace {

namespace fs = std::filesystem;

const fs::path kSceneFolder = PROMIN_SCENES_DIR;
const fs::path kGoldenFolder = PROMIN_GOLDENS_DIR;
const fs::path kResults = PROMIN_RESULTS_FILE;

/// Scenes with shapes, with meshes that share edges, and with glass.
constexpr const char* kCastScenes[] = {"all_primitives.gltf", "showcase.gltf", "glass.gltf"};

/// Hashes by the name of their content: "goldens", or "cast SCENE, DRIVER". The hits of different drivers may differ.
using Hashes = std::map<std::string, std::string>;

struct Results {
  int version = 0;
  Hashes hashes;
};

/// Returns the hash of the pixels of all stored pictures; their metadata may change.
std::string hash_goldens() {
  std::vector<fs::path> files{fs::directory_iterator(kGoldenFolder), fs::directory_iterator()};
  std::ranges::sort(files);
  jobs::Sha256 hash;
  for (const fs::path& file : files) {
    const Image picture = read_image(file);
    hash.add(file.filename().string() + "\n").add(std::as_bytes(std::span(picture.pixels)));
  }
  return hash.finish();
}

/// Returns the hash of the hits of rays through a scene. The rays start around the scene and point to positions in it.
std::string hash_casts(const gpu::Device& device, const std::string& name) {
  const Scene scene = load_scene(kSceneFolder / name);
  const Bounds bounds = bounds_of(scene);
  const vec3 middle = 0.5F * (bounds.lo + bounds.hi);
  const vec3 half = 0.5F * bounds.extent();
  std::minstd_rand random(1);
  const auto next = [&] { return static_cast<float>(random() >> 7) * 0x1p-23F - 1.0F; };
  const auto place = [&](float size) { return middle + size * half * vec3(next(), next(), next()); };
  std::vector<Ray> rays(4096);
  for (Ray& ray : rays) {
    ray.origin = place(3.0F);
    ray.direction = place(1.0F) - ray.origin;
  }
  std::vector<Hit> hits(rays.size());
  Caster(device, scene).cast(rays, hits);
  const auto is_hit = [](const Hit& hit) { return hit.object >= 0; };
  EXPECT_GT(std::ranges::count_if(hits, is_hit), 500) << name;
  return jobs::Sha256().add(std::as_bytes(std::span(hits))).finish();
}

Results read_results() {
  Results results;
  std::ifstream file(kResults);
  std::string line;
  while (std::getline(file, line)) {
    std::istringstream words(line);
    std::string first;
    words >> first;
    if (first == "version") {
      words >> results.version;
    } else if (first.size() == 64) {
      results.hashes[line.substr(first.size() + 1)] = first;
    }
  }
  return results;
}

void write_results(const Results& results) {
  std::string text = "version " + std::to_string(results.version) + "\n";
  for (const auto& [subject, hash] : results.hashes) text += hash + " " + subject + "\n";
  write_text_file(kResults, text);
}

class ResultsTest : public test::DeviceTest {};

TEST_F(ResultsTest, AreThoseOfTheirVersion) {
  const std::string driver = gpu::info_of(device()).name + ", " + gpu::info_of(device()).driver;
  Hashes now = {{"goldens", hash_goldens()}};
  for (const char* scene : kCastScenes) {
    now[std::string("cast ") + scene + ", " + driver] = hash_casts(device(), scene);
  }
  Results stored = read_results();
  const bool updates = std::getenv("PROMIN_UPDATE_GOLDENS") != nullptr;
  if (stored.version != work::kResultsVersion) {
    ASSERT_TRUE(updates) << "tests/golden/results.txt is of another version of results: run tools/update_goldens";
    stored = {work::kResultsVersion, {}};
  }
  for (const auto& [subject, hash] : now) {
    const auto known = stored.hashes.find(subject);
    if (known == stored.hashes.end()) {
      EXPECT_TRUE(updates || subject != "goldens") << "tools/update_goldens has recorded no " << subject;
      if (!updates) std::printf("no %s is recorded; tools/update_goldens records it\n", subject.c_str());
      continue;
    }
    EXPECT_EQ(known->second, hash)
        << "the results changed (" << subject
        << "): raise kResultsVersion in engine/work/jobs/results_version.h, because jobs that "
           "were begun before must not go on, and run tools/update_goldens";
  }
  if (!updates || HasFailure()) return;
  stored.hashes.merge(now);
  write_results(stored);
}

}  // namespace
}  // namespace promin
