// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/display/traced_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/divide_up.h"
#include "encode_film.spv.h"
#include "shared/layout.h"

namespace promin::app {
namespace {

using Access = vk::AccessFlagBits;
using Stage = vk::PipelineStageFlagBits;

/// Numbers of constants and bindings of shaders/window/encode_film.comp.
constexpr uint32_t kToneMapping = 0;
constexpr uint32_t kDithers = 2;
constexpr uint32_t kHasUnlit = 3;
constexpr uint32_t kEncodedBinding = 0;
constexpr uint32_t kExposureBinding = 1;

/// Largest number of workgroups that encode a film. It is enough for any device; the workgroups share the pixels.
constexpr uint32_t kMostEncodingGroups = 1024;

gpu::Buffer make_exposure_buffer(const gpu::Device& device) {
  return {device, sizeof(float), vk::BufferUsageFlagBits::eStorageBuffer};
}

}  // namespace

gpu::ComputePipeline make_encoder(const gpu::Device& device, const gpu::Buffer& film, const gpu::Buffer& encoded,
                                  const gpu::Buffer& exposure, const DisplayTransform& display, bool has_unlit) {
  const std::array constants{gpu::SpecializationConstant{kToneMapping, static_cast<uint32_t>(display.tone_mapping)},
                             gpu::SpecializationConstant{kDithers, display.dithers ? 1U : 0U},
                             gpu::SpecializationConstant{kHasUnlit, has_unlit ? 1U : 0U}};
  constexpr auto kStorage = vk::DescriptorType::eStorageBuffer;
  const std::array buffers{gpu::BoundBuffer{layout::BINDING_FILM, kStorage, &film},
                           gpu::BoundBuffer{kEncodedBinding, kStorage, &encoded},
                           gpu::BoundBuffer{kExposureBinding, kStorage, &exposure}};
  return {device, k_encode_film_spirv, constants, buffers};
}

TracedPicture::TracedPicture(SceneOn scene, FeatureMask features, double budget_ms, const DisplayTransform& display,
                             std::function<SceneOn()> set_apart, const FilmOptions& options)
    : scene_(std::move(scene)),
      display_(display),
      picture_(*scene_.device, scene_.scene, features, budget_ms, std::move(set_apart), options),
      exposure_(make_exposure_buffer(*scene_.device)),
      counters_(gpu::Buffer::make_readback(*scene_.device, Film::kCountersBytes)),
      work_(scene_.device) {}

TracedPicture::~TracedPicture() = default;

void TracedPicture::expose(float exposure_ev) {
  display_.exposure_ev = exposure_ev;
}

void TracedPicture::resize(const uvec2& size) {
  size_ = size;
  picture_.resize(size);
  const uvec2 full_size = picture_.full_size();
  const vk::DeviceSize bytes = vk::DeviceSize{full_size.x} * full_size.y * sizeof(uint32_t);
  if (!encoded_ || encoded_->size_bytes() < bytes) {
    encoded_.emplace(*scene_.device, bytes, vk::BufferUsageFlagBits::eStorageBuffer);
    words_.emplace(gpu::Buffer::make_readback(*scene_.device, bytes));
  }
  for (size_t i = 0; i < kFilmCount; ++i) {
    encoders_[i].emplace(
        make_encoder(*scene_.device, picture_.film(i), *encoded_, exposure_, display_, picture_.has_unlit()));
  }
  encoded_count_ = 0;
  has_encoded_ = false;
}

void TracedPicture::warm_up() {
  picture_.warm_up();
  // The commands encode the pixel that has just been traced.
  scene_.device->run([&](const vk::raii::CommandBuffer& commands) { encoders_[0]->dispatch(commands, uvec2(1)); });
}

bool TracedPicture::awaits_encoding() const {
  return picture_.shown() && (encoded_count_ != picture_.shown_count() || encoded_ev_ != display_.exposure_ev);
}

bool TracedPicture::has_work() const {
  return awaits_encoding() || (!picture_.is_settled() && !picture_.awaits_samples());
}

void TracedPicture::ask(double time_s) {
  if (!asked_time_) asked_time_ = time_s;
}

void TracedPicture::begin_frame(bool is_of_flight, double time_s,
                                const std::function<void(const vk::raii::CommandBuffer&)>& record_more) {
  ask(time_s);
  if (work_.is_busy()) return;
  if (picture_.refines_next()) begin_refining(time_s);
  const bool traces = !picture_.is_settled() && !picture_.refines_next();
  if (!traces && !awaits_encoding() && !record_more) return;
  const vk::raii::CommandBuffer& commands = work_.begin();
  work_.mark();
  // The previous frame may have copied a screenshot from the film that is traced now.
  commands.pipelineBarrier(Stage::eTransfer, Stage::eComputeShader, {}, {}, {}, {});
  frame_ = {};
  frame_.is_of_flight = is_of_flight;
  if (traces) frame_.units = picture_.record(commands);
  if (frame_.units > 0.0) picture_.record_take_counts(commands, counters_);
  work_.mark();
  is_encoding_ = awaits_encoding();
  if (is_encoding_) record_encoding(commands);
  if (record_more) record_more(commands);
  work_.mark();
  begin_time_ = std::exchange(asked_time_, std::nullopt).value_or(time_s);
  work_.submit();
}

void TracedPicture::begin_refining(double time_s) {
  const std::shared_ptr<const gpu::Device> device = picture_.refining_device();
  if (!device) return;
  if (!refining_) {
    refining_ = std::make_unique<DeviceWork>(device);
    refining_counters_.emplace(gpu::Buffer::make_readback(*device, Film::kCountersBytes));
  }
  if (refining_->is_busy()) return;
  const vk::raii::CommandBuffer& commands = refining_->begin();
  refining_->mark();
  refined_frame_ = {};
  refined_frame_.units = picture_.record(commands);
  refined_frame_.has_list = picture_.has_recorded_list();
  // If nothing was recorded, a picture is complete or there is no work.
  if (refined_frame_.units == 0.0) return refining_->drop();
  picture_.record_take_counts(commands, *refining_counters_);
  refining_->mark();
  begin_time_ = std::exchange(asked_time_, std::nullopt).value_or(time_s);
  refining_->submit();
}

void TracedPicture::record_encoding(const vk::raii::CommandBuffer& commands) {
  const ShownPicture& shown = *picture_.shown();
  const float exposure = std::exp2(display_.exposure_ev);
  commands.updateBuffer<float>(*exposure_.handle(), 0, exposure);
  const vk::MemoryBarrier traced(Access::eShaderWrite | Access::eTransferWrite, Access::eShaderRead);
  commands.pipelineBarrier(Stage::eComputeShader | Stage::eTransfer, Stage::eComputeShader, {}, traced, {}, {});
  constexpr uint32_t kLanes = layout::BLOCK_SIZE * layout::BLOCK_SIZE;
  const uint32_t pixel_count = shown.size.x * shown.size.y;
  encoders_[shown.film]->dispatch(commands, uvec2(std::min(divide_up(pixel_count, kLanes), kMostEncodingGroups), 1));
  const vk::MemoryBarrier encoded(Access::eShaderWrite, Access::eTransferRead);
  commands.pipelineBarrier(Stage::eComputeShader, Stage::eTransfer, {}, encoded, {}, {});
  commands.copyBuffer(*encoded_->handle(), *words_->handle(), vk::BufferCopy(0, 0, pixel_count * sizeof(uint32_t)));
  const vk::MemoryBarrier copied(Access::eTransferWrite, Access::eHostRead);
  commands.pipelineBarrier(Stage::eTransfer, Stage::eHost, {}, copied, {}, {});
  encoded_count_ = picture_.shown_count();
  encoded_ev_ = display_.exposure_ev;
  encoded_size_ = shown.size;
  has_encoded_ = false;
}

std::optional<FinishedFrame> TracedPicture::poll(double time_s) {
  if (work_.take_finished()) {
    frame_.stages.trace = work_.ms_after(0);
    frame_.stages.display = work_.ms_after(1);
    has_encoded_ = has_encoded_ || std::exchange(is_encoding_, false);
    return finish(frame_, counters_, time_s);
  }
  if (refining_ && refining_->take_finished()) {
    refined_frame_.stages.trace = refining_->ms_after(0);
    return finish(refined_frame_, *refining_counters_, time_s);
  }
  return std::nullopt;
}

FinishedFrame TracedPicture::finish(FinishedFrame frame, const gpu::Buffer& counters, double time_s) {
  if (frame.units > 0.0) {
    frame.rays = sum_counts(counters.mapped());
    frame.has_cut_loops = were_loops_cut(counters.mapped());
  }
  frame.time_ms = 1e3 * (time_s - std::max(begin_time_, last_end_time_));
  last_end_time_ = time_s;
  return frame;
}

void TracedPicture::learn(const FinishedFrame& frame) {
  picture_.take_finished({.units = frame.units,
                          .time_ms = frame.stages.trace > 0.0 ? frame.stages.trace : frame.time_ms,
                          .has_cut_loops = frame.has_cut_loops,
                          .has_list = frame.has_list});
}

std::optional<EncodedPicture> TracedPicture::take_encoded() {
  if (!has_encoded_ || work_.is_busy()) return std::nullopt;
  has_encoded_ = false;
  const std::span<const std::byte> bytes = words_->mapped();
  return EncodedPicture{{reinterpret_cast<const uint32_t*>(bytes.data()), bytes.size() / sizeof(uint32_t)},
                        encoded_size_};
}

}  // namespace promin::app
