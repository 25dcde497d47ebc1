// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/display/screenshot.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <bit>
#include <chrono>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

#include "options/render_options.h"
#include "output/outputs.h"
#include "promin/error.h"
#include "trace/film/film.h"
#include "work/pictures/picture_files.h"

namespace promin::app {
namespace fs = std::filesystem;

namespace {

constexpr int kLastNumber = 9999;

size_t area_of(const View& view) {
  return static_cast<size_t>(view.size.x) * view.size.y;
}

/// Returns the channels of Aovs::unlit, computed from sums over samples; empty if there are no sums.
std::vector<Channel> list_unlit_channels(std::span<const uvec4> sums, uint32_t samples) {
  Aovs aovs;
  for (const uvec4& sum : sums) aovs.unlit.push_back(std::bit_cast<vec4>(sum) / static_cast<float>(samples));
  return make_channels({}, std::move(aovs), {.unlit = !sums.empty()}, true);
}

std::string write_pictures(const std::vector<uvec4>& records, const View& view, const Metadata& metadata,
                           const DisplayTransform& display, const std::optional<fs::path>& file) {
  Image image;
  image.size = view.size;
  image.pixels.resize(area_of(view));
  average_samples(records, view.samples_per_pixel, image.pixels);
  const std::vector<Channel> unlit =
      list_unlit_channels(std::span(records).subspan(image.pixels.size()), view.samples_per_pixel);
  const std::string name = file ? "" : find_free_name(fs::current_path());
  const std::vector<fs::path> files = file ? std::vector{*file} : std::vector<fs::path>{name + ".exr", name + ".png"};
  for (const fs::path& written : files) write_image(written, image, metadata, std::nullopt, unlit, display);
  const std::string exactness =
      view.error_target ? describe_errors(view.error_target->error, view.error_target->error, *view.error_target)
                        : fmt::format("{} spp", view.samples_per_pixel);
  return fmt::format("wrote {}, {}x{}, {}", fmt::join(names_of(files), " and "), view.size.x, view.size.y, exactness);
}

}  // namespace

void Screenshot::record_copy(std::shared_ptr<const gpu::Device> device, const vk::raii::CommandBuffer& commands,
                             const gpu::Buffer& film, const View& view, bool has_unlit) {
  using Access = vk::AccessFlagBits;
  using Stage = vk::PipelineStageFlagBits;
  device_ = std::move(device);
  view_ = view;
  const vk::DeviceSize size = (has_unlit ? 2 : 1) * static_cast<vk::DeviceSize>(area_of(view)) * sizeof(uvec4);
  copy_.emplace(gpu::Buffer::make_readback(*device_, size));
  const vk::MemoryBarrier traced(Access::eShaderWrite, Access::eTransferRead);
  commands.pipelineBarrier(Stage::eComputeShader, Stage::eTransfer, {}, traced, {}, {});
  commands.copyBuffer(*film.handle(), *copy_->handle(), vk::BufferCopy(Film::kPixelsOffset, 0, size));
  const vk::MemoryBarrier copied(Access::eTransferWrite, Access::eHostRead);
  commands.pipelineBarrier(Stage::eTransfer, Stage::eHost, {}, copied, {}, {});
}

void Screenshot::write(const Metadata& metadata, const DisplayTransform& display, const std::optional<fs::path>& file) {
  std::vector<uvec4> records(copy_->size_bytes() / sizeof(uvec4));
  std::memcpy(records.data(), copy_->mapped().data(), copy_->size_bytes());
  copy_.reset();
  written_ = std::async(std::launch::async, write_pictures, std::move(records), view_, metadata, display, file);
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
  throw RunError({"window.screenshots.many", fmt::format("no number up to {} is free for a screenshot", kLastNumber),
                  folder.string(), "move some screenshots to another folder"});
}

}  // namespace promin::app
