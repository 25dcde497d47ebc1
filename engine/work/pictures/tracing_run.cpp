// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/tracing_run.h"

#include <fmt/ranges.h>

#include <cstdlib>
#include <numeric>
#include <string>

#include "core/limit_threads.h"
#include "core/stopwatch.h"
#include "promin/error.h"
#include "work/pictures/load_posed.h"
#include "work/pictures/memory_use.h"

namespace promin::work {

void choose_threads(const TracingOptions& options) {
  if (!options.threads) return;
  limit_threads(*options.threads);
  // Drivers read this variable when they start.
  setenv("LP_NUM_THREADS", std::to_string(*options.threads).c_str(), 1);
}

Scene load_for(const TracingOptions& options, RunStats& stats, const Messages& console,
               std::vector<SourceFile>& sources) {
  choose_threads(options);
  const Stopwatch load;
  Scene scene = load_posed(options.scene, options.load, options.motion, sources);
  stats.load_ms = load.ms();
  for (const std::string& warning : scene.warnings) console.warn(options.scene.string() + ": " + warning);
  stats.scene_file = options.scene.filename().string();
  stats.motion = options.motion;
  stats.instances = options.instances;
  stats.scene = count_scene(scene);
  stats.object_count = scene.objects.size();
  stats.material_count = scene.materials.size();
  stats.light_count = scene.lights.size();
  console.detail(fmt::format("loaded {}: objects {}, primitives {}, {:.1f} ms, {}", options.scene.string(),
                             scene.objects.size(), stats.scene.primitives, stats.load_ms, describe_memory()));
  return scene;
}

std::vector<std::filesystem::path> files_of(const std::vector<SourceFile>& sources) {
  std::vector<std::filesystem::path> files;
  for (const SourceFile& source : sources) files.push_back(source.file);
  return files;
}

gpu::DeviceHandle open_device_for(const TracingOptions& options, RunStats& stats, const Messages& console) {
  gpu::DeviceHandle device = gpu::open_device(options.device, !options.has_no_cache);
  stats.device = gpu::info_of(*device);
  console.detail(gpu::choice_of(*device));
  return device;
}

void take_setup(const SetupStats& setup, const gpu::Device& device, RunStats& stats, const Messages& console) {
  give_back_memory();
  stats.setup = setup;
  stats.kernels = gpu::kernel_stats_of(device);
  for (const Problem& warning : setup.warnings) console.warn(warning);
  console.detail(fmt::format("BVH by {}: {} nodes, depth {}, SAH cost {:.4g}, {:.1f} ms", setup.bvh.builder,
                             setup.bvh.nodes, setup.bvh.depth, setup.bvh.sah_cost, setup.bvh_ms));
  console.detail(fmt::format("features: {}", fmt::join(setup.features, ", ")));
  console.detail(fmt::format("upload {:.1f} ms ({:.1f} MB), pipeline {:.1f} ms, {}", setup.upload_ms,
                             1e-6 * static_cast<double>(setup.device_bytes), setup.pipeline_ms, describe_memory()));
  const std::string folder = stats.kernels.folder.empty() ? "" : " from " + stats.kernels.folder.string();
  console.detail(fmt::format("kernels: {} compiled, {} read{}", stats.kernels.compiled, stats.kernels.read, folder));
  for (const std::string& note : stats.kernels.notes) console.detail(note);
}

void tell_end(const RunStats& stats, const Messages& console) {
  console.detail(fmt::format(
      "traced {:.4g} Mrays in {:.1f} ms, wrote files in {:.1f} ms, {:.1f} ms in all; at most {:.0f} MB of memory",
      1e-6 * static_cast<double>(stats.rays.total()),
      std::accumulate(stats.trace_ms.begin(), stats.trace_ms.end(), 0.0), stats.write_ms, stats.total_ms,
      peak_memory_mb()));
}

void check_validation(const gpu::Device& device, const RunStats& stats) {
  const uint64_t count = gpu::validation_message_count(device);
  if (count == 0) return;
  throw RunError({"device.validation.reports", fmt::format("the Vulkan validation layers reported {} problems", count),
                  stats.device.name, "report them as a bug in promin"});
}

}  // namespace promin::work
