// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/scene_path.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <string>

#include "promin/error.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A scene in a folder "scene", with other folders beside it.
class ScenePathTest : public SceneFolder {
 protected:
  ScenePathTest() {
    for (const char* folder : {"scene/Textures", "textures", "store"}) fs::create_directories(folder_ / folder);
    for (const char* file : {"scene/a.png", "scene/Textures/b.PNG", "textures/c.png", "store/1234"}) write(file, file);
    fs::create_symlink("../store/1234", folder_ / "scene/link.png");
    fs::create_directory_symlink("../textures", folder_ / "scene/up");
  }

  /// Returns the content of a file that a scene names, or the reason why it is not read.
  std::string read(const std::string& name, const fs::path& root = {}, const std::string& scene = "scene") const {
    LoadReport report(folder_ / scene / "scene.gltf", false, root.empty() ? root : folder_ / root);
    const auto file = find_beside_scene(name, "images[0].uri", true, report);
    if (!file) return message_of([&] { report.throw_if_refused(); });
    EXPECT_EQ(report.sources().size(), 1U);
    std::string text;
    std::getline(std::ifstream(*file), text);
    return text;
  }
};

TEST_F(ScenePathTest, DotSegmentsAreRemovedFirst) {
  for (const char* name : {"a.png", "./a.png", ".//a.png", "none/../a.png", "Textures/../a.png", "up/../a.png",
                           "none\\..\\a.png", "../scene/a.png"}) {
    EXPECT_EQ(read(name), "scene/a.png") << name;
  }
  EXPECT_THAT(read("none/../../textures/c.png"), HasProblem("scene.name.outside (\"none/../../textures/c.png\")"));
}

TEST_F(ScenePathTest, WhatLiesElsewhereNeedsTheRoot) {
  for (const auto& [name, root, text] :
       {std::tuple("../textures/c.png", "textures", "textures/c.png"),
        std::tuple("up/c.png", "textures", "textures/c.png"), std::tuple("link.png", "store", "store/1234")}) {
    EXPECT_THAT(read(name), HasProblem("scene.name.outside --root DIR")) << name;
    EXPECT_EQ(read(name, root), text) << name;
    EXPECT_EQ(read(name, "."), text) << name;
    EXPECT_THAT(read(name, "scene"), HasProblem("scene.name.outside root")) << name;
  }
  EXPECT_THAT(read("link.png"), HasProblem("scene.name.outside link"));
  EXPECT_EQ(read("a.png", "store"), "scene/a.png") << "the scene's own folder stays";
}

TEST_F(ScenePathTest, AScenesLinkMayLeadIntoTheStoreToo) {
  fs::create_symlink("../store/1234", folder_ / "scene/scene.gltf");
  EXPECT_EQ(read("link.png", "store"), "store/1234");
  fs::create_directory_symlink("scene", folder_ / "linked");
  EXPECT_EQ(read("a.png", "", "linked"), "scene/a.png");
  EXPECT_EQ(read("../textures/c.png", "textures", "linked"), "textures/c.png");
}

TEST_F(ScenePathTest, AbsolutePathsNeedTheRootThatHoldsThem) {
  const std::string file = (folder_ / "textures/c.png").string();
  EXPECT_THAT(read(file), HasProblem("scene.name.outside absolute"));
  EXPECT_EQ(read(file, "textures"), "textures/c.png");
  EXPECT_THAT(read("/etc/hostname", "textures"), HasProblem("scene.name.outside root"));
  for (const char* name : {"file:a.png", "C:\\a.png", "http://a.org/a.png"}) {
    EXPECT_THAT(read(name, "."), HasProblem("scene.name.outside relative")) << name;
  }
}

TEST_F(ScenePathTest, MissingFilesNameThoseThatAreNear) {
  EXPECT_THAT(read("A.PNG"), HasProblem("file.missing (\"A.PNG\", did you mean \"a.png\"?)"));
  EXPECT_THAT(read("textures/B.png"),
              HasProblem("file.missing (\"textures/B.png\", did you mean \"Textures/b.PNG\"?)"));
  EXPECT_THAT(read("albedo.jpg"), AllOf(HasProblem("file.missing (\"albedo.jpg\")"), Not(HasSubstr("did you mean"))));
}

TEST_F(ScenePathTest, TheRootIsAFolder) {
  write("triangle.stl",
        "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n");
  EXPECT_NO_THROW(load_scene(folder_ / "triangle.stl", {.root = folder_}));
  EXPECT_THAT([&] { load_scene(folder_ / "triangle.stl", {.root = folder_ / "none"}); },
              FailsWith("scene.root.folder"));
}

}  // namespace
}  // namespace promin
