// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/plugin/upright.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

/// The orientation of a file's pixels.
struct Order {
  bool is_by_columns;
  bool is_from_right;
  bool is_from_bottom;
};

/// Orientations, indexed by OpenImageIO's attribute minus 1. They belong to the resolution strings -Y+X, -Y-X, +Y-X,
/// +Y+X, +X-Y, +X+Y, -X+Y, -X-Y, whose first axis is that of the file's rows.
constexpr std::array<Order, 8> kOrders = {{{false, false, false},
                                           {false, true, false},
                                           {false, true, true},
                                           {false, false, true},
                                           {true, false, false},
                                           {true, false, true},
                                           {true, true, true},
                                           {true, true, false}}};

/// An input that loads the whole picture into memory when the first row is read.
class UprightInput final : public OIIO::ImageInput {
 public:
  UprightInput(std::unique_ptr<OIIO::ImageInput> input, const Order& order) : input_(std::move(input)), order_(order) {
    m_spec = input_->spec();
    if (!order_.is_by_columns) return;
    std::swap(m_spec.width, m_spec.height);
    m_spec.full_width = m_spec.width;
    m_spec.full_height = m_spec.height;
  }

  const char* format_name() const override { return input_->format_name(); }
  bool open(const std::string& /*name*/, OIIO::ImageSpec& /*spec*/) override { return false; }
  bool close() override { return input_->close(); }

  bool read_native_scanline(int /*subimage*/, int /*miplevel*/, int y, int /*z*/, void* data) override {
    if (stored_.empty() && !read_all()) return false;
    const auto channels = static_cast<size_t>(m_spec.nchannels);
    auto* to = static_cast<float*>(data);
    for (int x = 0; x < m_spec.width; ++x) {
      to = std::copy_n(stored_.begin() + static_cast<std::ptrdiff_t>(place_of(x, y) * channels), channels, to);
    }
    return true;
  }

 private:
  bool read_all() {
    const OIIO::ImageSpec& spec = input_->spec();
    stored_.resize(spec.image_pixels() * static_cast<size_t>(spec.nchannels));
    if (input_->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, stored_.data())) return true;
    stored_.clear();
    errorfmt("{}", input_->geterror());
    return false;
  }

  /// Returns the position of a pixel in the file.
  size_t place_of(int x, int y) const {
    const auto u = static_cast<size_t>(order_.is_from_right ? m_spec.width - 1 - x : x);
    const auto v = static_cast<size_t>(order_.is_from_bottom ? m_spec.height - 1 - y : y);
    return order_.is_by_columns ? u * static_cast<size_t>(m_spec.height) + v
                                : v * static_cast<size_t>(m_spec.width) + u;
  }

  std::unique_ptr<OIIO::ImageInput> input_;
  Order order_;
  std::vector<float> stored_;
};

}  // namespace

std::unique_ptr<OIIO::ImageInput> make_upright(std::unique_ptr<OIIO::ImageInput> input) {
  if (std::string_view(input->format_name()) != "hdr") return input;
  const int orientation = input->spec().get_int_attribute("Orientation", 1);
  if (orientation < 2 || orientation > static_cast<int>(kOrders.size())) return input;
  return std::make_unique<UprightInput>(std::move(input), kOrders[static_cast<size_t>(orientation - 1)]);
}
