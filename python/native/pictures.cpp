// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "bind.h"
#include "image/channel_file.h"
#include "picture_arrays.h"
#include "promin/compare.h"
#include "promin/cryptomatte.h"
#include "promin/display.h"
#include "promin/error.h"
#include "promin/image.h"
#include "records.h"
#include "watched.h"

namespace nb = nanobind;

namespace promin::python {
namespace {

/// Values of a channel: 32-bit floats or integers.
using ChannelArray = nb::ndarray<const uint32_t, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
/// Values of Aovs::unlit, with the shape (rows, columns, 4).
using UnlitArray = nb::ndarray<const float, nb::shape<-1, -1, 4>, nb::c_contig, nb::device::cpu>;
/// The position (x, y) of a crop, and width and height of the whole picture.
using Placement = std::pair<std::pair<uint32_t, uint32_t>, std::pair<uint32_t, uint32_t>>;

void save(const std::filesystem::path& file, const PictureArray& pixels, const Metadata& metadata,
          const std::optional<Placement>& placement, const nb::list& channels, const nb::dict& display,
          const std::optional<nb::dict>& exr) {
  const Image image = read_image_array(pixels);
  std::vector<Channel> copies;
  for (const nb::handle row : channels) {
    const auto [name, is_integer, values] = nb::cast<std::tuple<std::string, bool, ChannelArray>>(row);
    copies.push_back({name, is_integer, {values.data(), values.data() + values.size()}});
  }
  std::optional<CropPlacement> crop;
  if (placement) {
    crop = CropPlacement{{placement->first.first, placement->first.second},
                         {placement->second.first, placement->second.second}};
  }
  const DisplayTransform transform = read_display(display);
  const ExrOptions options = exr ? read_exr_options(*exr) : ExrOptions();
  run_watched(nb::none(),
              [&](const ProgressCallback&) { write_image(file, image, metadata, crop, copies, transform, options); });
}

nb::object load_picture(const std::filesystem::path& file) {
  Image image;
  run_watched(nb::none(), [&](const ProgressCallback&) { image = read_image(file); });
  return write_image_array(std::move(image));
}

/// Returns the bits of a channel, read in all its rows.
std::vector<uint32_t> copy_channel(const ChannelFile& picture, const FileChannel& channel) {
  std::vector<uint32_t> values;
  values.reserve(size_t{channel.size.x} * channel.size.y);
  for (uint32_t y = 0; y < channel.size.y; ++y) {
    for (uint32_t x = 0; x < channel.size.x; ++x) values.push_back(picture.bits(channel, x, y));
  }
  return values;
}

/// Returns all channels of a file: the name, whether the values are integers, and the bits of the values.
nb::list load_channels(const std::filesystem::path& file) {
  std::vector<std::vector<uint32_t>> all;
  std::optional<ChannelFile> picture;
  run_watched(nb::none(), [&](const ProgressCallback&) {
    picture.emplace(file);
    picture->read_rows(0, picture->row_count());
    for (const FileChannel& channel : picture->channels()) all.push_back(copy_channel(*picture, channel));
  });
  nb::list rows;
  for (size_t i = 0; i < all.size(); ++i) {
    const FileChannel& channel = picture->channels()[i];
    rows.append(
        nb::make_tuple(channel.name, channel.is_integer, write_array<uint32_t>(std::move(all[i]), channel.size)));
  }
  return rows;
}

/// Returns the 8-bit picture. `unlit` is Aovs::unlit of the picture.
nb::object show(const PictureArray& pixels, const nb::dict& record, const std::optional<UnlitArray>& unlit) {
  Image image = read_image_array(pixels);
  std::vector<vec4> of_unlit(image.pixels.size(), vec4(0.0F));
  if (unlit) {
    if (unlit->shape(0) != image.size.y || unlit->shape(1) != image.size.x) {
      throw UsageError({"picture.pair.sizes", "the unlit coverage and the picture have different sizes", "",
                        "give a value for each pixel"});
    }
    if (!of_unlit.empty()) std::memcpy(of_unlit.data(), unlit->data(), of_unlit.size() * sizeof(vec4));
  }
  const DisplayTransform display = read_display(record);
  run_watched(nb::none(), [&](const ProgressCallback&) {
    for (size_t i = 0; i < image.pixels.size(); ++i) {
      const vec3 shown = apply(display, image.pixels[i], of_unlit[i]);
      image.pixels[i] = vec3(encode_srgb(shown.x), encode_srgb(shown.y), encode_srgb(shown.z));
    }
  });
  return write_image_array(std::move(image));
}

nb::dict compare(const PictureArray& first, const PictureArray& second, bool is_linear, double fail) {
  const Image reference = read_image_array(first);
  const Image test = read_image_array(second);
  const CompareChoice choice{.encoding = is_linear ? PictureEncoding::kLinear : PictureEncoding::kSrgb, .fail = fail};
  PictureDifference difference;
  run_watched(nb::none(), [&](const ProgressCallback&) { difference = compare_pictures(reference, test, choice); });
  nb::dict record;
  record["pixel_count"] = difference.pixel_count;
  record["mean"] = difference.mean;
  record["rmse"] = difference.rmse;
  record["psnr_db"] = difference.psnr_db;
  record["largest"] = difference.largest;
  record["largest_at"] = nb::make_tuple(difference.largest_at.x, difference.largest_at.y);
  record["different_count"] = difference.different_count;
  record["non_finite_count"] = difference.non_finite_count;
  record["flip"] = difference.flip;
  record["flip_map"] = write_array<float>(std::move(difference.flip_map), reference.size);
  return record;
}

}  // namespace

Image read_image_array(const PictureArray& pixels) {
  Image image;
  // A size that does not fit into 32 bits becomes a size that the library refuses.
  image.size = {static_cast<uint32_t>(pixels.shape(1)), static_cast<uint32_t>(pixels.shape(0))};
  image.pixels.resize(pixels.shape(0) * pixels.shape(1));
  if (!image.pixels.empty()) std::memcpy(image.pixels.data(), pixels.data(), image.pixels.size() * sizeof(vec3));
  return image;
}

nb::object write_image_array(Image image) {
  return write_array<float>(std::move(image.pixels), image.size);
}

void bind_pictures(nb::module_& module) {
  module.def("write_image", &save, nb::arg("file"), nb::arg("pixels").noconvert(), nb::arg("metadata"),
             nb::arg("placement").none(), nb::arg("channels"), nb::arg("display"), nb::arg("exr").none());
  module.def("read_image", &load_picture, nb::arg("file"));
  module.def("read_channels", &load_channels, nb::arg("file"));
  module.def("show", &show, nb::arg("pixels").noconvert(), nb::arg("display"), nb::arg("unlit").none());
  module.def("compare", &compare, nb::arg("first").noconvert(), nb::arg("second").noconvert(), nb::arg("is_linear"),
             nb::arg("fail"));
  module.def("has_named_channels", [](const std::filesystem::path& file) { return has_named_channels(file); });
  module.def("cryptomatte_id", [](const std::string& name) { return std::bit_cast<float>(cryptomatte_id(name)); });
  module.def("encoding_is_linear",
             [](const std::filesystem::path& file) { return encoding_of(file) == PictureEncoding::kLinear; });
}

}  // namespace promin::python
