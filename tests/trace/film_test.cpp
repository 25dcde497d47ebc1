// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/film.h"

#include <gtest/gtest.h>

#include "device/device.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

class FilmTest : public test::DeviceTest {};

// A driver gives out memory with its old content. If a kernel took its numbers from it, the check of loops would turn
// up to 2^32 times: a driver that ends loops then reports cut ones; with another driver the device is busy for a
// minute.
TEST_F(FilmTest, WarmsUpWhateverItsMemoryHeld) {
  const world::Scene scene = test::make_scene_of_everything();
  const PackedScene packed = pack_scene(scene, "sah");
  Film film(device(),
            upload_scene(device(), packed, {scene.materials, scene.textures, scene.lights, scene.environment}),
            features_of(scene));
  film.reserve(64);
  device().run([&](const vk::raii::CommandBuffer& commands) {
    commands.fillBuffer(*film.buffer().handle(), 0, VK_WHOLE_SIZE, ~0U);
  });
  film.warm_up();
  EXPECT_FALSE(film.take_counts().has_cut_loops);
}

}  // namespace
}  // namespace promin
