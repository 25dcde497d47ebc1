// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

// The interface between the engine and libpromin_pictures.so, the plugin that reads picture files with OpenImageIO. It
// is C: the two sides share no class, and no exception crosses the interface. The engine opens the plugin with the
// first picture (image/open_pictures.h), because loading OpenImageIO's libraries takes longer than most commands.

#include <stddef.h>  // NOLINT(modernize-deprecated-headers): this file is C as well.
#include <stdint.h>  // NOLINT(modernize-deprecated-headers)

#ifdef __cplusplus
extern "C" {
#endif

/// The version of this interface, which changes with every change of this file. The engine refuses a plugin with
/// another version before it calls any other function.
#define PROMIN_PICTURES_INTERFACE 9

/// The result of a call.
enum ProminPicturesStatus {
  PROMIN_PICTURES_DONE = 0,
  /// The call failed; the message has the reason in one line.
  PROMIN_PICTURES_FAILED = 1,
  PROMIN_PICTURES_OUT_OF_MEMORY = 2,
};

/// A buffer that belongs to the caller. If a call fails, the plugin writes a text to it, shortened to fit and
/// terminated by a zero.
struct ProminPicturesMessage {
  char text[1024];
};

enum ProminPicturesSample {
  PROMIN_PICTURES_UINT32 = 0,
  PROMIN_PICTURES_FLOAT = 1,
};

struct ProminPicturesChannel {
  const char* name;
  /// The type of the channel's values, one of ProminPicturesSample.
  uint32_t sample;
};

/// A picture file that is open for reading.
struct ProminPicturesReader;

struct ProminPicturesInfo {
  uint64_t width, height;
  /// 1 for a flat picture; 0 for volumes and deep pictures.
  uint32_t is_flat;
  /// Index of the first of three channels R, G, B, or of the channel Y, a luminance without chroma; -1 if there are
  /// none.
  int32_t first_rgb_channel;
  /// Number of parts of an EXR; 1 for other files. The members above describe the first part.
  uint32_t part_count;
};

/// A part of an EXR, or the whole picture. The reader owns the memory to which the members point, until the next part
/// is described.
struct ProminPicturesPart {
  uint64_t width, height;
  /// 1 for a flat part; 0 for volumes and deep pictures.
  uint32_t is_flat;
  /// Name of the part; empty if the file has no name for it.
  const char* name;
  /// The channels. A channel of integers has the type PROMIN_PICTURES_UINT32, all other channels PROMIN_PICTURES_FLOAT.
  const struct ProminPicturesChannel* channels;
  size_t channel_count;
};

/// Returns the value of PROMIN_PICTURES_INTERFACE with which the plugin was built.
uint32_t promin_pictures_interface(void);

/// Opens a file of any format that OpenImageIO supports. Colours of EXR and WebP files are multiplied by alpha; colours
/// of other files are not. After success the caller must close `reader`.
int promin_pictures_open(const char* file, struct ProminPicturesReader** reader, struct ProminPicturesInfo* info,
                         struct ProminPicturesMessage* message);

/// Opens a file in memory. `format` is OpenImageIO's name of its format, such as "webp". The memory must stay valid
/// until the reader is closed. Everything else is as for promin_pictures_open. Any number of threads may call this
/// function.
int promin_pictures_open_bytes(const void* bytes, size_t byte_count, const char* format,
                               struct ProminPicturesReader** reader, struct ProminPicturesInfo* info,
                               struct ProminPicturesMessage* message);

/// Fills the caller's 4 * width * height bytes with red, green, blue and alpha of each pixel. Values of 0 and less
/// become 0; values of 1 and more become 255. One channel is read as grey, two channels as grey and alpha. If there are
/// three, alpha is 255.
int promin_pictures_read_rgba(struct ProminPicturesReader* reader, unsigned char* pixels,
                              struct ProminPicturesMessage* message);

/// Fills the caller's 3 * width * height floats with R, G and B of each pixel, or with Y three times, without
/// conversion of colours.
int promin_pictures_read_rgb(struct ProminPicturesReader* reader, float* pixels, struct ProminPicturesMessage* message);

/// Describes a part by its number, counted from 0. Not for readers from promin_pictures_open_bytes.
int promin_pictures_describe_part(struct ProminPicturesReader* reader, uint32_t part, struct ProminPicturesPart* info,
                                  struct ProminPicturesMessage* message);

/// Fills the caller's memory with the values of some rows of a part: four bytes for each channel of each pixel. They
/// are integers for integer channels of an EXR, and otherwise floats without colour conversion. Reading an EXR is
/// fastest in multiples of 32 rows.
int promin_pictures_read_rows(struct ProminPicturesReader* reader, uint32_t part, uint32_t first_row,
                              uint32_t row_count, void* pixels, struct ProminPicturesMessage* message);

/// Writes a whole picture to an existing file of any name. Format "webp", in which only alpha is lossless, and format
/// "tiff" store 8-bit sRGB with three channels, or with four and unassociated alpha. Format "hdr" stores three floats
/// of linear light. Equal pixels give equal bytes.
int promin_pictures_write(const char* file, const char* format, uint32_t width, uint32_t height, uint32_t channel_count,
                          const void* pixels, struct ProminPicturesMessage* message);

/// Draws a line of UTF-8 text in the middle of a strip of this size, as large as it fits. `font` is a font file. Fills
/// the caller's width * height bytes with the coverage of each pixel by letters; 255 is full coverage.
int promin_pictures_draw_text(const char* font, const char* text, uint32_t width, uint32_t height,
                              unsigned char* coverage, struct ProminPicturesMessage* message);

/// Closes a reader; ignores null.
void promin_pictures_close(struct ProminPicturesReader* reader);

#ifdef __cplusplus
}
#endif
