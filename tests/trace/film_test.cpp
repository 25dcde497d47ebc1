// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/film/film.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "device/device.h"
#include "device/side_compiler.h"
#include "gpu/device_fixture.h"
#include "gpu/test_scenes.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

class FilmTest : public test::DeviceTest {};

// A driver may return memory that still has its old content. If a kernel read numbers from this memory, the loop that
// checks loops could run up to 2^32 times. A driver that ends loops would then report cut loops. With another driver
// the device would be busy for a minute.
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

/// Returns the size in bytes of Mesa's cache after a film was warmed up with an empty cache. With `on_second_device` a
/// second device compiles the largest kernel first.
uintmax_t cache_bytes(bool on_second_device) {
  const std::filesystem::path cache =
      std::filesystem::path(testing::TempDir()) / ("promin_film_test_" + std::to_string(getpid()));
  const char* const old = std::getenv("MESA_SHADER_CACHE_DIR");
  const std::optional<std::string> before = old == nullptr ? std::nullopt : std::optional<std::string>(old);
  setenv("MESA_SHADER_CACHE_DIR", cache.c_str(), 1);
  {
    const gpu::DeviceHandle device = gpu::open_device(gpu::DeviceOptions{.pixel_packet_size = 1});
    const world::Scene scene = test::make_scene_of_everything();
    const PackedScene packed = pack_scene(scene, "sah");
    Film film(*device,
              upload_scene(*device, packed, {scene.materials, scene.textures, scene.lights, scene.environment}),
              features_of(scene));
    if (on_second_device) gpu::compile_on_second_device(*device, *film.side_kernel());
    film.warm_up();
  }
  uintmax_t bytes = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(cache)) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  std::filesystem::remove_all(cache);
  unsetenv("MESA_SHADER_CACHE_DIR");
  if (before) setenv("MESA_SHADER_CACHE_DIR", before->c_str(), 1);
  return bytes;
}

// A picture keeps its films in a vector, which moves them.
TEST_F(FilmTest, TheSideKernelHasTheBuffersOfAMovedFilm) {
  const world::Scene scene = test::make_scene_of_everything();
  const PackedScene packed = pack_scene(scene, "sah");
  Film film(device(),
            upload_scene(device(), packed, {scene.materials, scene.textures, scene.lights, scene.environment}),
            features_of(scene));
  const Film moved = std::move(film);
  const auto kernel = moved.side_kernel();
  ASSERT_TRUE(kernel);
  EXPECT_TRUE(std::ranges::any_of(kernel->buffers, [&](const auto& bound) { return bound.buffer == &moved.buffer(); }));
}

// Otherwise the second device would compile another variant of the kernel, which no device uses.
TEST_F(FilmTest, TheSecondDeviceCompilesTheVariantThatTheFirstUses) {
  if (!device().profile().compiles_on_second_device) GTEST_SKIP() << "the driver compiles no kernels in dispatches";
  const uintmax_t bytes = cache_bytes(false);
  EXPECT_GT(bytes, 0U);
  // Files of the cache are compressed, and their sizes vary by some bytes. Another variant would add a tenth.
  EXPECT_NEAR(static_cast<double>(cache_bytes(true)), static_cast<double>(bytes), 0.01 * static_cast<double>(bytes));
}

}  // namespace
}  // namespace promin
