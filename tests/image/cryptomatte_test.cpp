// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/cryptomatte.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

namespace promin {
namespace {

// These hashes are from PyPI's mmh3 5.2. Two of them have the exponents 0 and 255, for which the specification flips a
// bit.
TEST(Cryptomatte, IdsAreHashesOfNames) {
  EXPECT_EQ(cryptomatte_id("cone"), 0x106f2ad6U);
  EXPECT_EQ(cryptomatte_id("left pane"), 0x42376642U);
  EXPECT_EQ(cryptomatte_id("pearl 0"), 0xd4195a09U);
  EXPECT_EQ(cryptomatte_id("a"), 0x3c2569b2U);
  EXPECT_EQ(cryptomatte_id("Ünïcode"), 0xf095bc36U);
  EXPECT_EQ(cryptomatte_id("name 368"), 0x000dcb4fU ^ 0x00800000U);
  EXPECT_EQ(cryptomatte_id("name 708"), 0x7fb669caU ^ 0x00800000U);
  for (const char* name : {"", "name 368", "name 708"}) {
    EXPECT_TRUE(std::isnormal(std::bit_cast<float>(cryptomatte_id(name)))) << name;
  }
}

class CryptomatteTest : public testing::Test {
 protected:
  CryptomatteTest() {
    scene_.materials.resize(2);
    scene_.materials[0].name = "stone";
    for (const char* name : {"wall", "pane", "wall", ""}) scene_.objects.push_back({name, 0, 0});
    AovSet set;
    set.cryptomatte = true;
    aovs_.resize(2, set);
    aovs_.object_coverage[0] = {Coverage{1, 0.5F}, Coverage{0, 0.25F}, Coverage{2, 0.125F}, Coverage{3, 0.125F}};
    aovs_.material_coverage[0] = {Coverage{1, 1.0F}};
  }

  /// Returns the coverage of each id in a layer's pixel. The function uses only the letters of the channels.
  static std::map<uint32_t, float> decode(const Cryptomatte& cryptomatte, const std::string& layer, size_t pixel) {
    std::map<std::string, uint32_t> values;
    for (const Channel& channel : cryptomatte.channels) values[channel.name] = channel.values.at(pixel);
    std::map<uint32_t, float> coverage;
    for (const char* group : {"00.", "01.", "02."}) {
      for (const auto& [id, share] : {std::pair("R", "G"), std::pair("B", "A")}) {
        const auto covered = std::bit_cast<float>(values.at(layer + group + share));
        if (covered > 0.0F) coverage[values.at(layer + group + id)] += covered;
      }
    }
    return coverage;
  }

  Scene scene_;
  Aovs aovs_;
};

TEST_F(CryptomatteTest, WhatHasOneNameIsOneMatte) {
  const Cryptomatte cryptomatte = make_cryptomatte(scene_, aovs_);
  EXPECT_EQ(cryptomatte.channels.size(), 24U);
  using Coverages = std::map<uint32_t, float>;
  EXPECT_EQ(decode(cryptomatte, "CryptoObject", 0), (Coverages{{cryptomatte_id("pane"), 0.5F},
                                                               {cryptomatte_id("wall"), 0.375F},
                                                               {cryptomatte_id("object 3"), 0.125F}}));
  EXPECT_EQ(decode(cryptomatte, "CryptoMaterial", 0), (Coverages{{cryptomatte_id("material 1"), 1.0F}}));
  EXPECT_EQ(decode(cryptomatte, "CryptoObject", 1), Coverages{});
  // The channels with the largest coverage come first.
  EXPECT_EQ(cryptomatte.channels[0].name, "CryptoObject00.R");
  EXPECT_EQ(cryptomatte.channels[0].values[0], cryptomatte_id("pane"));
}

TEST_F(CryptomatteTest, TheManifestNamesEachId) {
  std::map<std::string, std::string> metadata;
  for (const auto& [name, value] : make_cryptomatte(scene_, aovs_).metadata) metadata[name] = value;
  // The key has the first seven digits of the layer's hash, which is 3ae39a58 by mmh3.
  const std::string key = "cryptomatte/3ae39a5/";
  EXPECT_EQ(metadata.at(key + "name"), "CryptoObject");
  EXPECT_EQ(metadata.at(key + "hash"), "MurmurHash3_32");
  EXPECT_EQ(metadata.at(key + "conversion"), "uint32_to_float32");
  const auto manifest = nlohmann::json::parse(metadata.at(key + "manifest"));
  ASSERT_EQ(manifest.size(), 3U);
  for (const auto& [name, id] : manifest.items()) {
    EXPECT_EQ(std::stoul(id.get<std::string>(), nullptr, 16), cryptomatte_id(name)) << name;
    EXPECT_EQ(id.get<std::string>().size(), 8U) << name;
  }
}

}  // namespace
}  // namespace promin
