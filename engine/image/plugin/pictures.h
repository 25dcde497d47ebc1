// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

// The interface between the engine and libpromin_pictures.so, the plugin that reads picture files with OpenImageIO. It
// is C: the two sides share no class, and no exception crosses it. The engine opens the plugin with the first picture
// (image/open_pictures.h), because loading OpenImageIO's libraries takes longer than most commands.

#include <stddef.h>  // NOLINT(modernize-deprecated-headers): this file is C as well.
#include <stdint.h>  // NOLINT(modernize-deprecated-headers)

#ifdef __cplusplus
extern "C" {
#endif

/// This number changes with every change of this file. The engine refuses a plugin of another number before it calls
/// anything else.
#define PROMIN_PICTURES_INTERFACE 9

/// The result of a call.
enum ProminPicturesStatus {
  PROMIN_PICTURES_DONE = 0,
  /// The message says why, in one line.
  PROMIN_PICTURES_FAILED = 1,
  PROMIN_PICTURES_OUT_OF_MEMORY = 2,
};

/// A buffer of the caller's. Where the call fails, the plugin fills it, cut to fit and ended by a zero.
struct ProminPicturesMessage {
  char text[1024];
};

enum ProminPicturesSample {
  PROMIN_PICTURES_UINT32 = 0,
  PROMIN_PICTURES_FLOAT = 1,
};

struct ProminPicturesChannel {
  const char* name;
  /// The value is one of ProminPicturesSample.
  uint32_t sample;
};

/// A picture file that is open for reading.
struct ProminPicturesReader;

struct ProminPicturesInfo {
  uint64_t width, height;
  /// 0 for volumes and deep pictures.
  uint32_t is_flat;
  /// The first of three channels named R, G, B, or the one named Y, a luminance without chroma; -1 where there are
  /// none.
  int32_t first_rgb_channel;
  /// Parts of an EXR, of which the above is said of the first; else 1.
  uint32_t part_count;
};

/// A part of an EXR, or the one picture. What it leads to is the reader's, until the next part is described.
struct ProminPicturesPart {
  uint64_t width, height;
  /// 0 for volumes and deep pictures.
  uint32_t is_flat;
  /// Empty where the file names none.
  const char* name;
  /// Those with integers are of PROMIN_PICTURES_UINT32, and all others of PROMIN_PICTURES_FLOAT.
  const struct ProminPicturesChannel* channels;
  size_t channel_count;
};

/// The PROMIN_PICTURES_INTERFACE that the plugin was built with.
uint32_t promin_pictures_interface(void);

/// Opens a file of any format that OpenImageIO knows. Alpha is kept apart from colours, but of EXR and WebP. Where it
/// succeeds, `reader` is to be closed by the caller.
int promin_pictures_open(const char* file, struct ProminPicturesReader** reader, struct ProminPicturesInfo* info,
                         struct ProminPicturesMessage* message);

/// Opens a file in memory, which must stay there until the reader is closed, by OpenImageIO's name of its format, such
/// as "webp". Else as promin_pictures_open; any number of threads may call it.
int promin_pictures_open_bytes(const void* bytes, size_t byte_count, const char* format,
                               struct ProminPicturesReader** reader, struct ProminPicturesInfo* info,
                               struct ProminPicturesMessage* message);

/// Fills the caller's 4 * width * height bytes with red, green, blue and alpha of each pixel, 0 for 0 and less, 255 for
/// 1 and more: one channel is grey, two are grey and alpha, of three alpha is 255.
int promin_pictures_read_rgba(struct ProminPicturesReader* reader, unsigned char* pixels,
                              struct ProminPicturesMessage* message);

/// Fills the caller's 3 * width * height floats with R, G, B, or three times Y, of each pixel, without conversion of
/// colours.
int promin_pictures_read_rgb(struct ProminPicturesReader* reader, float* pixels, struct ProminPicturesMessage* message);

/// Describes a part by its number from 0; not for what promin_pictures_open_bytes gave.
int promin_pictures_describe_part(struct ProminPicturesReader* reader, uint32_t part, struct ProminPicturesPart* info,
                                  struct ProminPicturesMessage* message);

/// Fills four bytes of the caller's for each channel of each pixel of some rows of a part: the integers of an EXR, and
/// floats of all else, without conversion of colours. EXRs are read fast by multiples of 32 rows.
int promin_pictures_read_rows(struct ProminPicturesReader* reader, uint32_t part, uint32_t first_row,
                              uint32_t row_count, void* pixels, struct ProminPicturesMessage* message);

/// Writes a whole picture to a file that is there, of any name: "webp", with loss but for alpha, or "tiff", of 8 bits
/// in sRGB with three or, with unassociated alpha, four channels; or "hdr" of three floats of linear light. Equal
/// pixels give equal bytes.
int promin_pictures_write(const char* file, const char* format, uint32_t width, uint32_t height, uint32_t channel_count,
                          const void* pixels, struct ProminPicturesMessage* message);

/// Draws a line of UTF-8 text by the font of a file, as large as a strip of so many pixels holds it, in the strip's
/// middle. Fills the caller's width * height bytes with the share of each pixel that letters cover, 255 for all of it.
int promin_pictures_draw_text(const char* font, const char* text, uint32_t width, uint32_t height,
                              unsigned char* coverage, struct ProminPicturesMessage* message);

/// Closes what promin_pictures_open gave; nothing happens to null.
void promin_pictures_close(struct ProminPicturesReader* reader);

#ifdef __cplusplus
}
#endif
