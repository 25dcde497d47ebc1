// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/decode_picture.h"

#include <png.h>
#include <turbojpeg.h>

#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "image/open_pictures.h"
#include "image/picture_formats.h"
#include "promin/error.h"
#include "promin/textures.h"

namespace promin {
namespace {

static_assert(std::endian::native == std::endian::little, "texels have red in the lowest byte");

void check_size(uint64_t width, uint64_t height) {
  if (width == 0 || height == 0) throw DecodeError("it has no pixels");
  if (width <= kMaxTextureSide && height <= kMaxTextureSide && width * height <= kMaxTextureTexels) return;
  throw DecodeError("its size of " + std::to_string(width) + "x" + std::to_string(height) + " is too large", false);
}

/// Reads a PNG file with libpng. libpng returns from errors by longjmp, so no object with a destructor may be created
/// between setjmp and a call of libpng.
class PngReader {
 public:
  explicit PngReader(std::span<const std::byte> file) : rest_(file) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, take_error, take_warning);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, this, take_bytes);
    // Text and colour profiles are skipped, so that they use no memory.
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, 0);
    png_set_user_limits(png_, kMaxTextureSide, kMaxTextureSide);
    png_set_chunk_malloc_max(png_, 1U << 20);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  uvec2 read_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) throw DecodeError(error_.data());
    png_read_info(png_, info_);
    return {png_get_image_width(png_, info_), png_get_image_height(png_, info_)};
  }

  void read_texels(const uvec2& size, uint32_t* texels) {
    if (setjmp(png_jmpbuf(png_)) != 0) throw DecodeError(error_.data());
    png_set_expand(png_);
    png_set_scale_16(png_);
    png_set_gray_to_rgb(png_);
    png_set_add_alpha(png_, 0xFF, PNG_FILLER_AFTER);
    const int passes = png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    if (png_get_rowbytes(png_, info_) != size_t{4} * size.x) png_error(png_, "its rows have the wrong length");
    for (int pass = 0; pass < passes; ++pass) {
      for (uint32_t row = 0; row < size.y; ++row) {
        png_read_row(png_, reinterpret_cast<png_bytep>(texels + size_t{row} * size.x), nullptr);
      }
    }
  }

 private:
  static void take_bytes(png_structp png, png_bytep to, size_t count) {
    auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
    if (count > reader.rest_.size()) png_error(png, "it ends too early");
    std::memcpy(to, reader.rest_.data(), count);
    reader.rest_ = reader.rest_.subspan(count);
  }
  [[noreturn]] static void take_error(png_structp png, png_const_charp message) {
    auto& reader = *static_cast<PngReader*>(png_get_error_ptr(png));
    std::strncpy(reader.error_.data(), message, reader.error_.size() - 1);
    png_longjmp(png, 1);
  }
  static void take_warning(png_structp, png_const_charp) {}

  std::span<const std::byte> rest_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::array<char, 256> error_{};
};

class JpegReader {
 public:
  explicit JpegReader(std::span<const std::byte> file)
      : handle_(tjInitDecompress(), tjDestroy),
        data_(reinterpret_cast<const unsigned char*>(file.data())),
        bytes_(file.size()) {
    if (!handle_) throw std::bad_alloc();
  }

  uvec2 read_header() {
    int width = 0;
    int height = 0;
    int subsampling = 0;
    int colors = 0;
    check(tjDecompressHeader3(handle_.get(), data_, bytes_, &width, &height, &subsampling, &colors));
    if (colors == TJCS_CMYK || colors == TJCS_YCCK) throw DecodeError("its colours are CMYK", false);
    return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
  }

  void read_texels(const uvec2& size, uint32_t* texels) {
    check(tjDecompress2(handle_.get(), data_, bytes_, reinterpret_cast<unsigned char*>(texels),
                        static_cast<int>(size.x), 0, static_cast<int>(size.y), TJPF_RGBA,
                        TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS));
  }

  const std::string& warning() const { return warning_; }

 private:
  /// Checks the result of a call of the library. After a warning the readable part of the picture is still decoded.
  void check(int result) {
    if (result == 0) return;
    if (tjGetErrorCode(handle_.get()) != TJERR_WARNING) throw DecodeError(tjGetErrorStr2(handle_.get()));
    warning_ = tjGetErrorStr2(handle_.get());
  }

  std::unique_ptr<void, int (*)(tjhandle)> handle_;
  const unsigned char* data_;
  unsigned long bytes_;
  std::string warning_;
};

/// Reads a file in any other format that the plugin for pictures supports.
class PluginReader {
 public:
  PluginReader(std::span<const std::byte> file, const PictureFormat& format)
      : plugin_(open_plugin()), reader_(nullptr, plugin_.close), file_(file), format_(format) {}

  uvec2 read_header() {
    // The size in the header is checked first, because libraries allocate memory for the picture when they open it.
    if (const std::optional<uvec2> size = read_told_size(file_, format_)) check_size(size->x, size->y);
    ProminPicturesInfo info{};
    ProminPicturesReader* opened = nullptr;
    check(plugin_.open_bytes(file_.data(), file_.size(), format_.name, &opened, &info, &message_));
    reader_.reset(opened);
    if (info.is_flat == 0) throw DecodeError("it is not a two-dimensional picture", false);
    check_size(info.width, info.height);
    return {static_cast<uint32_t>(info.width), static_cast<uint32_t>(info.height)};
  }

  void read_texels(const uvec2& /*size*/, uint32_t* texels) {
    check(plugin_.read_rgba(reader_.get(), reinterpret_cast<unsigned char*>(texels), &message_));
  }

 private:
  static const PicturesPlugin& open_plugin() {
    try {
      return open_pictures();
    } catch (const RunError& error) {
      throw DecodeError(error.problems().front().what, false);
    }
  }
  void check(int status) {
    if (status == PROMIN_PICTURES_OUT_OF_MEMORY) throw std::bad_alloc();
    if (status != PROMIN_PICTURES_DONE) throw DecodeError(format_.name + std::string(": ") + message_.text);
  }

  const PicturesPlugin& plugin_;
  std::unique_ptr<ProminPicturesReader, decltype(PicturesPlugin::close)> reader_;
  std::span<const std::byte> file_;
  const PictureFormat& format_;
  ProminPicturesMessage message_{};
};

/// Calls task with the reader for the file's format, which the first bytes determine.
template <typename Task>
auto with_reader(std::span<const std::byte> file, const Task& task) {
  const PictureFormat* format = find_picture_format(file);
  if (format == nullptr) throw DecodeError("its format is unknown");
  if (std::string_view(format->name) == "png") {
    PngReader reader(file);
    return task(reader);
  }
  if (std::string_view(format->name) == "jpeg") {
    JpegReader reader(file);
    return task(reader);
  }
  PluginReader reader(file, *format);
  return task(reader);
}

template <typename Reader>
uvec2 read_checked_header(Reader& reader) {
  const uvec2 size = reader.read_header();
  check_size(size.x, size.y);
  return size;
}

}  // namespace

uvec2 read_picture_size(std::span<const std::byte> file) {
  return with_reader(file, [](auto& reader) { return read_checked_header(reader); });
}

DecodedPicture decode_picture(std::span<const std::byte> file) {
  return with_reader(file, [](auto& reader) {
    DecodedPicture picture;
    picture.size = read_checked_header(reader);
    picture.texels.resize(uint64_t{picture.size.x} * picture.size.y);
    reader.read_texels(picture.size, picture.texels.data());
    if constexpr (requires { reader.warning(); }) picture.warning = reader.warning();
    return picture;
  });
}

}  // namespace promin
