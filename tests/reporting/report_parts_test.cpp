// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The report's parts that need no device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>

#include "device_scene/pack_scene.h"
#include "measure/meshes.h"
#include "measure/samples.h"
#include "oracle/distance.h"
#include "oracle/oracle.h"
#include "promin/error.h"
#include "promin/load_scene.h"
#include "reporting/aimed_rays.h"
#include "reporting/misjudged.h"
#include "reporting/scene_hash.h"
#include "reporting/scene_names.h"
#include "reporting/session.h"

namespace promin::report {
namespace {

using testing::ElementsAre;

TEST(ReportSceneHash, IsTheSameForEveryBuilderAndOtherForOtherContent) {
  const world::Scene scene =
      world::flatten(load_scene(std::filesystem::path(PROMIN_SCENES_DIR) / "all_primitives.gltf"));
  const std::string hash = hash_of(scene);
  EXPECT_EQ(hash.size(), 16);
  for (const char* builder : {"median", "sah", "spatial"}) {
    pack_scene(scene, builder);
    EXPECT_EQ(hash_of(scene), hash) << builder;
  }
  std::vector<world::Scene> others(10, scene);
  others[0].materials[0].phong().diffuse.y += 0.01F;
  others[1].materials[0].phong().shininess += 1.0F;
  others[2].lights.emplace_back();
  others[3].cameras.at(0).eye.x += 0.5F;
  others[4].environment.background.z += 0.1F;
  others[5].environment.ambient.z += 0.1F;
  std::swap(others[6].objects[0], others[6].objects[1]);
  others[7].objects.pop_back();
  others[8].objects[0].shape = world::Sphere{vec3(0.0F), 0.25F};
  others[9].objects[0].material += 1;
  std::vector<std::string> hashes = {hash};
  for (const world::Scene& other : others) {
    EXPECT_THAT(hashes, testing::Not(testing::Contains(hash_of(other)))) << &other - others.data();
    hashes.push_back(hash_of(other));
  }
  world::Scene renamed = scene;
  renamed.objects[0].name = "another";
  renamed.file = "another.gltf";
  EXPECT_EQ(hash_of(renamed), hash);
}

TEST(ReportAimedRays, AreOfEachPrimitiveAndMeetItFromInside) {
  Random random(1);
  std::set<size_t> kinds;
  for (const std::string& name : primitive_names()) {
    kinds.insert(make_primitive(name, dvec3(0.0), random).objects[0].shape.index());
    const Enclosure enclosure = make_enclosure(name, 300, random);
    EXPECT_EQ(enclosure.rays.empty(), name == "plane");
    size_t at_creases = 0;
    for (const Ray& ray : enclosure.rays) {
      const oracle::Ray exact{oracle::Vector(ray.origin), oracle::Vector(ray.direction), ray.tmin, ray.tmax};
      const oracle::Hit hit = oracle::find_nearest_hit(enclosure.scene, exact);
      ASSERT_TRUE(hit.exists()) << name;
      const oracle::Vector point = exact.origin + hit.t * exact.direction;
      at_creases += oracle::distance_to_crease(enclosure.scene.objects[0].shape, point) < 1e-6L ? 1 : 0;
    }
    const bool has_creases = name == "cylinder" || name == "cone" || name == "box";
    EXPECT_GE(at_creases, has_creases ? 225U : 0U) << name;
  }
  EXPECT_EQ(kinds.size(), primitive_names().size());
  EXPECT_THROW(make_primitive("torus", dvec3(0.0), random), UsageError);
}

TEST(ReportSceneNames, AreAsLongAsTellsThemApart) {
  EXPECT_THAT(name_scenes({"a/x.gltf", "b/y.gltf"}), ElementsAre("x", "y"));
  EXPECT_THAT(name_scenes({"x.gltf", "x.obj", "y.obj"}), ElementsAre("x.gltf", "x.obj", "y"));
  EXPECT_THAT(name_scenes({"a/x.gltf", "b/x.gltf"}), ElementsAre("a/x.gltf", "b/x.gltf"));
  EXPECT_THAT(name_scenes({"/1/a/x.gltf", "/2/a/x.gltf", "/2/b/x.gltf", "/2/b/x.obj"}),
              ElementsAre("1/a/x.gltf", "2/a/x.gltf", "b/x.gltf", "x.obj"));
  // A name that another's longer one would take.
  EXPECT_THAT(name_scenes({"/q/x.gltf", "/q/x.gltf.obj", "/q/x.obj"}), ElementsAre("q/x.gltf", "x.gltf.obj", "x.obj"));
  EXPECT_TRUE(name_scenes({}).empty());
  EXPECT_TRUE(is_same_file("a/../x.gltf", "./x.gltf"));
  EXPECT_FALSE(is_same_file("a/x.gltf", "x.gltf"));
}

/// A ray that hits the ball and one that does not, and answers to them.
class ReportMisjudged : public testing::Test {
 protected:
  Misjudged judge(const std::vector<Hit>& hits, const std::vector<size_t>& chosen) const {
    return judge_by_oracle(scene_, rays_, hits, chosen, ask_oracle(scene_, rays_, chosen));
  }

  world::Scene scene_ = measure::scene_of({world::Sphere{vec3(0.0F), 1.0F}});
  std::vector<Ray> rays_ = {{vec3(0.0F, 0.0F, 3.0F), 0.0F, vec3(0.0F, 0.0F, -1.0F)},
                            {vec3(0.0F, 2.0F, 3.0F), 0.0F, vec3(0.0F, 0.0F, -1.0F)}};
  Hit hit_{2.0F, 0, 0};
  Hit miss_;
  std::vector<size_t> all_ = {0, 1};
};

TEST_F(ReportMisjudged, AsksTheOracleAndNotTheOtherKernel) {
  const Misjudged right = judge(std::vector{hit_, miss_}, all_);
  EXPECT_EQ(right.lost + right.invented, 0);
  EXPECT_EQ(right.worst_margin, 0.0);
  const Misjudged wrong = judge(std::vector{miss_, hit_}, all_);
  EXPECT_EQ(wrong.lost, 1);
  EXPECT_EQ(wrong.invented, 1);
  EXPECT_GT(wrong.worst_margin, 1e5);
  const Misjudged first = judge(std::vector{miss_, hit_}, {0});
  EXPECT_EQ(first.lost, 1);
  EXPECT_EQ(first.invented, 0);
}

TEST_F(ReportMisjudged, KnowsThatEachRayFromInsideHits) {
  EXPECT_EQ(judge_in_closed_mesh(std::vector{hit_, miss_, miss_}).lost, 2);
  EXPECT_EQ(judge_in_closed_mesh(std::vector{hit_}).lost, 0);
}

TEST_F(ReportMisjudged, ChoosesAllThatDiffer) {
  std::vector<Hit> a(1000, miss_);
  std::vector<Hit> b = a;
  a[17] = hit_;
  b[990] = hit_;
  const std::vector<size_t> few = choose_rays(a, b, 1'000'000, 1'000'000);
  EXPECT_EQ(few.size(), 64);
  EXPECT_THAT(few, testing::IsSupersetOf({17, 990}));
  EXPECT_EQ(choose_rays(a, b, 1, 1'000'000).size(), 1000);
}

TEST(ReportGap, TellsWhatIsAbsentFromWhatFailed) {
  EXPECT_FALSE(json_of_gap("POV-Ray", std::nullopt)["is_installed"].get<bool>());
  const Json failed = json_of_gap("POV-Ray", "Cannot open file");
  EXPECT_TRUE(failed["is_installed"].get<bool>());
  EXPECT_EQ(failed["reason"], "Cannot open file");
}

TEST(ReportTurns, EachHasAllInAnotherOrder) {
  std::vector<int> ran;
  std::vector<std::function<double()>> contestants;
  for (int i = 0; i < 4; ++i) {
    contestants.emplace_back([&ran, i] {
      ran.push_back(i);
      return static_cast<double>(i);
    });
  }
  const std::vector<std::vector<double>> times = measure::time_in_turns(contestants, 20);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(times[i], std::vector<double>(20, i));
  std::set<std::vector<int>> orders;
  for (size_t first = 4; first < ran.size(); first += 4) {
    const std::vector<int> order(ran.begin() + static_cast<std::ptrdiff_t>(first),
                                 ran.begin() + static_cast<std::ptrdiff_t>(first + 4));
    EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), 4U);
    orders.insert(order);
  }
  EXPECT_GE(orders.size(), 10U);
}

}  // namespace
}  // namespace promin::report
