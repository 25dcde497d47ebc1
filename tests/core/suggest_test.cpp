// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/suggest.h"

#include <gtest/gtest.h>

#include <array>
#include <span>

namespace promin {
namespace {

constexpr std::array<std::string_view, 3> kKnown = {"sphere", "cylinder", "cone"};

TEST(Suggest, FindsTheNameWithAFewWrongLetters) {
  EXPECT_EQ(nearest_name("spere", kKnown), "sphere");
  EXPECT_EQ(nearest_name("Cilynder", kKnown), "cylinder");
  EXPECT_EQ(nearest_name("CONE", kKnown), "cone");
  EXPECT_EQ(nearest_name("cones", kKnown), "cone");
  EXPECT_EQ(nearest_name("cnoe", kKnown), "cone") << "two letters that changed places count as one";
}

TEST(Suggest, StaysSilentWhereNothingIsNear) {
  EXPECT_EQ(nearest_name("torus", kKnown), "");
  EXPECT_EQ(nearest_name("", kKnown), "");
  EXPECT_EQ(nearest_name("cone", {}), "");
  constexpr std::array<std::string_view, 1> kShort = {"x"};
  EXPECT_EQ(nearest_name("y", kShort), "");
}

TEST(Suggest, AlwaysListsWhatIsKnown) {
  EXPECT_EQ(suggest_name("cne", kKnown), "did you mean \"cone\"? Known: sphere, cylinder, cone");
  EXPECT_EQ(suggest_name("torus", kKnown), "known: sphere, cylinder, cone");
}

TEST(Suggest, ListsChoicesAsASentenceDoes) {
  EXPECT_EQ(list_choices(kKnown), "sphere, cylinder or cone");
  EXPECT_EQ(list_choices(std::span(kKnown).first(2)), "sphere or cylinder");
  EXPECT_EQ(list_choices(std::span(kKnown).first(1)), "sphere");
  EXPECT_EQ(list_choices({}), "");
}

}  // namespace
}  // namespace promin
