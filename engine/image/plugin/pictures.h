// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

// The interface between the engine and libpromin_pictures.so, the plugin that reads and writes picture files with
// OpenImageIO. It is C: the two sides share no class, and no exception crosses it. The engine opens the plugin with the
// first picture (image/open_pictures.h), because loading OpenImageIO's libraries takes longer than most commands.

#include <stddef.h>  // NOLINT(modernize-deprecated-headers): this file is C as well.
#include <stdint.h>  // NOLINT(modernize-deprecated-headers)

#ifdef __cplusplus
extern "C" {
#endif

/// This number changes with every change of this file. The engine refuses a plugin of another number before it calls
/// anything else.
#define PROMIN_PICTURES_INTERFACE 6

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
  PROMIN_PICTURES_UINT8 = 0,
  PROMIN_PICTURES_UINT32 = 1,
  PROMIN_PICTURES_FLOAT = 2,
  /// Pixels have floats, which the file keeps as halves: the nearest, or the largest that are finite.
  PROMIN_PICTURES_HALF = 3,
};

struct ProminPicturesChannel {
  const char* name;
  /// The value is one of ProminPicturesSample.
  uint32_t sample;
};

struct ProminPicturesAttribute {
  const char* name;
  const char* value;
};

/// A picture to write. Everything in it is the caller's, and is read during the call alone.
struct ProminPicturesSource {
  /// OpenImageIO's name of the format: "openexr" or "png".
  const char* format;
  /// The file's name without a folder, for messages. Of an EXR of several parts the path that it is to be written to:
  /// OpenImageIO writes there itself, and not to the sink.
  const char* file_name;
  /// Of an EXR, OpenImageIO's name.
  const char* compression;
  /// Whether an EXR has a part for each group of channels whose names have the same word before their last dot; those
  /// without one, and R, G, B and A, are the first.
  uint32_t is_multipart;
  uint32_t width, height;
  /// Where the pixels lie in the whole picture; the whole itself where full_width is 0.
  uint32_t x, y, full_width, full_height;
  const struct ProminPicturesChannel* channels;
  size_t channel_count;
  const struct ProminPicturesAttribute* attributes;
  size_t attribute_count;
};

/// Takes bytes of the encoded file and their place in it; they belong to the plugin and are gone after the call.
/// Returns 0 where they cannot be kept; the picture fails then. Must not throw.
struct ProminPicturesSink {
  void* context;
  int (*write)(void* context, uint64_t place, const void* bytes, size_t byte_count);
};

/// Room of the caller's for what a writer cannot hand on yet and should not keep in memory: that of an EXR of several
/// parts, which a file has one after the other. `reserve` comes first, once, with the size of it all; what was written
/// is read. Each returns 0 where it fails; the picture fails then. Must not throw.
struct ProminPicturesScratch {
  void* context;
  int (*reserve)(void* context, uint64_t byte_count);
  int (*write)(void* context, uint64_t place, const void* bytes, size_t byte_count);
  int (*read)(void* context, uint64_t place, void* bytes, size_t byte_count);
};

/// A picture file that is being written.
struct ProminPicturesWriter;

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

/// Begins a file. Where it succeeds, `writer` is to be ended by the caller. Equal sources and pixels give equal bytes.
/// The sink and the scratch are copied; what they lead to stays until the writer is ended.
int promin_pictures_begin(const struct ProminPicturesSource* source, const struct ProminPicturesSink* sink,
                          const struct ProminPicturesScratch* scratch, struct ProminPicturesWriter** writer,
                          struct ProminPicturesMessage* message);

/// Encodes the next rows, from the top: pixel after pixel, the channels in their order without padding, those of
/// PROMIN_PICTURES_UINT8 a byte each and all others four.
int promin_pictures_write_rows(struct ProminPicturesWriter* writer, uint32_t row_count, const void* pixels,
                               struct ProminPicturesMessage* message);

/// Completes the file after its last row.
int promin_pictures_finish(struct ProminPicturesWriter* writer, struct ProminPicturesMessage* message);

/// Ends what promin_pictures_begin gave, finished or not; nothing happens to null.
void promin_pictures_end(struct ProminPicturesWriter* writer);

/// Opens a file of any format that OpenImageIO knows. Where it succeeds, `reader` is to be closed by the caller.
int promin_pictures_open(const char* file, struct ProminPicturesReader** reader, struct ProminPicturesInfo* info,
                         struct ProminPicturesMessage* message);

/// Opens a file in memory, which must stay there until the reader is closed, by OpenImageIO's name of its format, such
/// as "webp". Alpha is kept apart from colours. Else as promin_pictures_open; any number of threads may call it.
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

/// Closes what promin_pictures_open gave; nothing happens to null.
void promin_pictures_close(struct ProminPicturesReader* reader);

#ifdef __cplusplus
}
#endif
