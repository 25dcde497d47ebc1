// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/screenshot.h"

#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <vector>

#include "promin/error.h"
#include "render_options.h"
#include "trace/film.h"

namespace promin::app {
namespace fs = std::filesystem;

namespace {

constexpr int kLastNumber = 9999;

std::string write_pictures(const std::vector<uvec4>& records, const View& view, const Metadata& metadata,
                           const DisplayTransform& display) {
  Image image;
  image.size = view.size;
  image.pixels.resize(records.size());
  average_samples(records, view.samples_per_pixel, image.pixels);
  const std::string name = find_free_name(fs::current_path());
  for (const char* ending : {".exr", ".png"}) {
    write_image(name + ending, image, metadata, std::nullopt, {}, display);
  }
  const std::string exactness =
      view.error_target ? describe_errors(view.error_target->error, view.error_target->error, *view.error_target)
                        : fmt::format("{} spp", view.samples_per_pixel);
  return fmt::format("wrote {0}.exr and {0}.png, {1}x{2}, {3}", name, view.size.x, view.size.y, exactness);
}

}  // namespace

void Screenshot::record_copy(const vk::raii::CommandBuffer& commands, const gpu::Buffer& film, const View& view) {
  using Access = vk::AccessFlagBits;
  using Stage = vk::PipelineStageFlagBits;
  view_ = view;
  const vk::DeviceSize size = static_cast<vk::DeviceSize>(view.size.x) * view.size.y * sizeof(uvec4);
  copy_.emplace(gpu::Buffer::make_readback(*device_, size));
  const vk::MemoryBarrier traced(Access::eShaderWrite, Access::eTransferRead);
  commands.pipelineBarrier(Stage::eComputeShader, Stage::eTransfer, {}, traced, {}, {});
  commands.copyBuffer(*film.handle(), *copy_->handle(), vk::BufferCopy(Film::kPixelsOffset, 0, size));
  const vk::MemoryBarrier copied(Access::eTransferWrite, Access::eHostRead);
  commands.pipelineBarrier(Stage::eTransfer, Stage::eHost, {}, copied, {}, {});
}

void Screenshot::write(const Metadata& metadata, const DisplayTransform& display) {
  std::vector<uvec4> records(static_cast<size_t>(view_.size.x) * view_.size.y);
  std::memcpy(records.data(), copy_->mapped().data(), records.size() * sizeof(uvec4));
  copy_.reset();
  written_ = std::async(std::launch::async, write_pictures, std::move(records), view_, metadata, display);
}

void Screenshot::wait() const {
  if (written_.valid()) written_.wait();
}

std::optional<std::string> Screenshot::take() {
  if (!written_.valid() || written_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    return std::nullopt;
  }
  return written_.get();
}

std::string find_free_name(const fs::path& folder) {
  for (int number = 1; number <= kLastNumber; ++number) {
    const std::string name = fmt::format("promin-{:04}", number);
    if (!fs::exists(folder / (name + ".exr")) && !fs::exists(folder / (name + ".png"))) return name;
  }
  throw RunError({fmt::format("no number up to {} is free for a screenshot", kLastNumber), folder.string(),
                  "move some elsewhere"});
}

}  // namespace promin::app
