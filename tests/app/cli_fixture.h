// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "promin/image.h"
#include "promin/ray.h"
#include "support/golden_messages.h"
#include "support/process.h"

namespace promin {

using OptionValues = std::vector<std::string>;

/// A triangle without camera or light.
inline constexpr const char* kTriangleObj = R"(o triangle
v -1 -1 0
v 1 -1 0
v 0 1 0
f 1 2 3
)";

/// A unit square at z = 0 with a point source and two cameras. Its material is Phong's model, whose kernels compile
/// fastest.
inline constexpr const char* kSquareGltf =
    R"({
  "asset": {"version": "2.0"},
  "extensionsUsed": ["KHR_lights_punctual", "PROMIN_materials_phong"],
  "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 3}]}},
  "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,)"
    R"(AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAACAPwAAgD8AAAAAAACAvwAAgD8AAAAAAAABAAIAAAACAAMA"}],
  "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
  "accessors": [
    {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
    {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
  "materials": [{"extensions": {"PROMIN_materials_phong": {}}}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
  "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7853981633974483, "znear": 0.01}}],
  "nodes": [
    {"mesh": 0},
    {"name": "main", "camera": 0, "translation": [0, 0, 4]},
    {"name": "side", "camera": 0, "translation": [1, 0.5, 3]},
    {"translation": [0, 0, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
  "scenes": [{"nodes": [0, 1, 2, 3]}],
  "scene": 0
})";

/// Returns the square with glTF's default material, lit by a part of the studio and shown with an exposure and a tone
/// mapping.
inline std::string make_default_gltf() {
  nlohmann::json gltf = nlohmann::json::parse(kSquareGltf);
  gltf["extensionsUsed"] = {"KHR_lights_punctual"};
  gltf.erase("materials");
  gltf["meshes"][0]["primitives"][0].erase("material");
  return gltf.dump();
}

/// Returns two squares side by side: the left one is lit, the right one has an unlit colour, linear RGB of 0.5, 0.25
/// and 0.02.
inline std::string make_mixed_gltf() {
  nlohmann::json gltf = nlohmann::json::parse(make_default_gltf());
  gltf["extensionsUsed"].push_back("KHR_materials_unlit");
  gltf["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 0.25, 0.02, 1}}}},
                        {"extensions", {{"KHR_materials_unlit", nlohmann::json::object()}}}}};
  gltf["meshes"].push_back(gltf["meshes"][0]);
  gltf["meshes"][1]["primitives"][0]["material"] = 0;
  gltf["nodes"][0]["translation"] = {-1.2, 0, 0};
  gltf["nodes"].push_back({{"mesh", 1}, {"translation", {1.2, 0, 0}}});
  gltf["scenes"][0]["nodes"].push_back(gltf["nodes"].size() - 1);
  return gltf.dump();
}

/// Runs the program in a folder of its own that holds two scenes.
class CliTest : public testing::Test {
 protected:
  void SetUp() override {
    // Tests of several suites have the same name and run at the same time, so the folder's name has both.
    options_.folder = std::filesystem::path(testing::TempDir()) / ("promin_cli_" + std::to_string(getpid()));
    std::filesystem::remove_all(folder());
    std::filesystem::create_directories(folder());
    write("triangle.obj", kTriangleObj);
    write("square.gltf", kSquareGltf);
  }
  void TearDown() override { std::filesystem::remove_all(folder()); }

  const std::filesystem::path& folder() const { return options_.folder; }

  void write(const std::string& file, const std::string& text) const { std::ofstream(folder() / file) << text; }

  void write_rays(const std::string& file, const std::vector<Ray>& rays) const {
    const std::string header =
        "{'descr': '<f4', 'fortran_order': False, 'shape': (" + std::to_string(rays.size()) + ", 8), }\n";
    std::string bytes("\x93NUMPY\x01\0", 8);
    bytes += static_cast<char>(header.size());
    bytes += '\0';
    bytes += header;
    bytes.append(reinterpret_cast<const char*>(rays.data()), rays.size() * sizeof(Ray));
    std::ofstream(folder() / file, std::ios::binary) << bytes;
  }

  std::string read(const std::string& file) const {
    std::ifstream stream(folder() / file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  /// Returns the names of the files in the folder except the scenes.
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder())) names.insert(entry.path().filename());
    names.erase("triangle.obj");
    names.erase("square.gltf");
    return names;
  }

  /// Simulates a full disk: no file can grow beyond this number of bytes.
  void fill_disk(size_t most_bytes) {
    options_.max_file_bytes = most_bytes;
    options_.environment["LD_PRELOAD"] = PROMIN_FULL_DISK_LIBRARY;
    // A sanitizer checks that it is loaded first. The check is off, because the library replaces no
    // function that sanitizers intercept.
    options_.environment["ASAN_OPTIONS"] = "verify_asan_link_order=0";
  }

  ProcessResult run(const OptionValues& arguments) const {
    return Process(PROMIN_EXECUTABLE, arguments, options_).wait();
  }

  /// Renders in a small size, and fails the test if the program fails.
  Image render(OptionValues arguments, const std::string& output) const {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"-o", output, "--quiet"});
    const ProcessResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.exit_code == 0 ? read_image(folder() / output) : Image{};
  }

  ProcessOptions options_;
};

/// Expects a failure with one line "PROGRAM: SENTENCE". `part` is a part of the sentence, or a code of
/// tests/messages/messages.txt and words; the sentence must then have the words of a golden sentence with this code,
/// and those words.
inline void expect_failure(const ProcessResult& result, int exit_code, const std::string& part,
                           const std::string& program = "promin") {
  static const GoldenMessages messages = read_golden_messages(PROMIN_SOURCE_DIR "/tests/messages/messages.txt");
  EXPECT_EQ(result.exit_code, exit_code) << result.err;
  EXPECT_THAT(result.out, testing::IsEmpty());
  ASSERT_THAT(result.err, testing::EndsWith("\n"));
  const size_t before = result.err.rfind('\n', result.err.size() - 2);
  const std::string line = result.err.substr(before == std::string::npos ? 0 : before + 1);
  ASSERT_THAT(line, testing::StartsWith(program + ": ")) << result.err;
  std::istringstream words(part);
  std::string word;
  words >> word;
  if (!messages.contains(word)) {
    EXPECT_THAT(line, testing::HasSubstr(part));
    return;
  }
  const std::string sentence = line.substr(program.size() + 2);
  EXPECT_TRUE(has_golden_words(messages, word, sentence)) << sentence << "is no sentence of " << word;
  while (words >> word) EXPECT_THAT(sentence, testing::HasSubstr(word));
}

}  // namespace promin
