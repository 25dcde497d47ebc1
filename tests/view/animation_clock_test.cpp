// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/animation_clock.h"

#include <gtest/gtest.h>

#include <memory>

#include "promin/motion.h"

namespace promin::app {
namespace {

Scene make_moving() {
  auto motion = std::make_shared<Motion>();
  motion->animations = {Animation{.name = "walk", .duration_s = 2.0}, Animation{.name = "", .duration_s = 5.0},
                        Animation{.name = "walk", .duration_s = 1.0}};
  Scene scene;
  scene.motion = motion;
  return scene;
}

MotionOptions at(const std::string& word, double time_s) {
  return {.animations = {word}, .time_s = time_s};
}

TEST(AnimationClockTest, AStillSceneHasNoClips) {
  AnimationClock clock{Scene()};
  EXPECT_TRUE(clock.clips().empty());
  clock.toggle();
  clock.step(1);
  clock.choose_next();
  EXPECT_FALSE(clock.is_playing());
  EXPECT_FALSE(clock.pose().any());
}

TEST(AnimationClockTest, PlaysInTimeAndRepeats) {
  AnimationClock clock{make_moving()};
  EXPECT_FALSE(clock.pose().any()) << "it begins with the pose of the nodes";
  clock.advance(3.0);
  clock.toggle();
  clock.advance(10.0);
  EXPECT_EQ(clock.pose(), at("walk", 0.0)) << "time before the start does not count";
  clock.advance(10.5);
  EXPECT_EQ(clock.pose(), at("walk", 0.5));
  clock.set_speed(2.0);
  clock.advance(11.0);
  EXPECT_EQ(clock.pose(), at("walk", 1.5));
  clock.advance(11.5);
  EXPECT_EQ(clock.pose(), at("walk", 0.5));
  clock.toggle();
  clock.advance(12.0);
  EXPECT_EQ(clock.pose(), at("walk", 0.5));
}

TEST(AnimationClockTest, StepsStopAndWrap) {
  AnimationClock clock{make_moving()};
  clock.toggle();
  clock.step(1);
  EXPECT_FALSE(clock.is_playing());
  EXPECT_EQ(clock.pose(), at("walk", 1.0 / 24.0));
  clock.step(-2);
  EXPECT_NEAR(clock.time_s(), 2.0 - 1.0 / 24.0, 1e-12);
}

TEST(AnimationClockTest, WordsChooseEachClip) {
  AnimationClock clock{make_moving()};
  std::vector<std::string> words;
  for (const AnimationClock::Clip& clip : clock.clips()) words.push_back(clip.word);
  EXPECT_EQ(words, (std::vector<std::string>{"walk", "1", "2", "all"}));
  EXPECT_EQ(clock.clips().back().duration_s, 5.0);
  for (const std::string& word : words) {
    clock.choose_next();
    EXPECT_EQ(clock.pose(), at(word, 0.0));
  }
  clock.choose(-1);
  EXPECT_FALSE(clock.pose().any());
}

TEST(AnimationClockTest, BeginsWithThePoseOfTheCommandLine) {
  const MotionOptions opened{.animations = {"1"}, .time_s = 1.5};
  AnimationClock clock{make_moving(), opened};
  EXPECT_EQ(clock.pose(), opened);
  EXPECT_EQ(clock.clip(), 1);
  EXPECT_EQ(clock.time_s(), 1.5);
  EXPECT_EQ((AnimationClock{make_moving(), {.animations = {"all"}, .time_s = 1.0}}.clip()), 3);
}

}  // namespace
}  // namespace promin::app
