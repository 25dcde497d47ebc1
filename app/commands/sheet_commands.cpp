// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/sheet_commands.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <cmath>
#include <memory>
#include <optional>

#include "core/count_of.h"
#include "core/divide_up.h"
#include "image/open_pictures.h"
#include "options/help.h"
#include "options/render_options.h"
#include "options/tracing_options.h"
#include "output/console.h"
#include "output/deferred_signals.h"
#include "output/font.h"
#include "output/message_of.h"
#include "output/outputs.h"
#include "output/progress.h"
#include "output/shown_picture.h"
#include "promin/error.h"
#include "promin/image.h"
#include "promin/validate.h"
#include "work/pictures/tracing_run.h"
#include "work/spec/check_spec.h"

namespace promin::app {
namespace fs = std::filesystem;

namespace {

constexpr uint32_t kThumbnailSide = 256;
/// The largest side of a thumbnail in pixels.
constexpr uint32_t kMaxThumbnailSide = 2048;
constexpr uvec2 kSheetPicture = {320, 240};
constexpr uint32_t kMaxColumns = 1000;
/// Distance in pixels between the pictures of a sheet and around them.
constexpr uint32_t kGap = 12;
/// Height in pixels of the strip with the name below a picture.
constexpr uint32_t kNameHeight = 20;
/// Colours in linear light: the paper of the sheet, and the area of a picture that could not be made.
constexpr vec3 kPaper{1.0F};
constexpr vec3 kNoPicture{0.6F};
constexpr vec3 kInk{0.02F};

/// Writes a picture completely or not at all. If the name has no extension of a picture, it writes a PNG, which file
/// managers expect.
void write_picture(const fs::path& file, const Image& image) {
  const fs::path made = is_writable_format(file) ? file : fs::path(file.string() + ".promin.png");
  const DeferredSignals while_writing;
  write_image(made, image);
  if (made != file) fs::rename(made, file);
}

gpu::DeviceHandle open_device_of(const TracingOptions& options, const Console& console) {
  choose_threads(options);
  RunStats stats;
  return open_device_for(options, stats, console);
}

void make_thumbnail(const RenderSpec& options) {
  check_outputs({options.tracing.scene}, options.pictures, {});
  const Console console(Verbosity::kQuiet);
  const Image image = render_shown(options, *open_device_of(options.tracing, console), console);
  write_picture(options.pictures.front(), image);
}

struct SheetOptions {
  std::vector<fs::path> scenes;
  /// Options of a sheet: its file, and the options that all pictures share.
  RenderSpec each;
  std::optional<uint32_t> columns;
};

/// The positions of the pictures on a sheet.
class SheetLayout {
 public:
  SheetLayout(const uvec2& picture, uint32_t count, std::optional<uint32_t> columns)
      : picture_(picture),
        columns_(columns ? std::min(*columns, count) : static_cast<uint32_t>(std::ceil(std::sqrt(count)))),
        rows_(divide_up(count, columns_)) {}

  uvec2 size() const { return kGap + uvec2(columns_, rows_) * cell(); }
  /// Returns the upper left pixel of a picture.
  uvec2 place(uint32_t i) const { return kGap + uvec2(i % columns_, i / columns_) * cell(); }
  const uvec2& picture() const { return picture_; }

 private:
  uvec2 cell() const { return picture_ + uvec2(kGap, kNameHeight + kGap); }

  uvec2 picture_;
  uint32_t columns_;
  uint32_t rows_;
};

void paste(const Image& picture, const uvec2& place, Image& sheet) {
  for (uint32_t y = 0; y < picture.size.y; ++y) {
    for (uint32_t x = 0; x < picture.size.x; ++x) sheet.at(place.x + x, place.y + y) = picture.at(x, y);
  }
}

/// Returns a strip of paper with a name on it. Throws RunError if the plugin for pictures is missing.
Image draw_name(const std::string& name, const fs::path& font, uint32_t width) {
  Image strip{{width, kNameHeight}, std::vector<vec3>(size_t{width} * kNameHeight)};
  std::vector<unsigned char> coverage(strip.pixels.size());
  ProminPicturesMessage message;
  if (open_pictures().draw_text(font.c_str(), name.c_str(), width, kNameHeight, coverage.data(), &message) !=
      PROMIN_PICTURES_DONE) {
    throw RunError({"sheet.name.drawn", fmt::format("the names cannot be drawn ({})", message.text), font.string(),
                    "install DejaVu Sans"});
  }
  for (size_t i = 0; i < coverage.size(); ++i) {
    strip.pixels[i] = mix(kPaper, kInk, static_cast<float>(coverage[i]) / 255.0F);
  }
  return strip;
}

/// Renders a scene of a sheet. After a failure it reports the reason and returns nullopt; the sheet then has an empty
/// area.
std::optional<Image> render_cell(const RenderSpec& options, const gpu::Device& device, const Console& console) {
  try {
    return render_shown(options, device, Console(console.is_verbose() ? Verbosity::kVerbose : Verbosity::kQuiet));
  } catch (const InputError& error) {
    console.warn(message_of(error));
  } catch (const UsageError& error) {
    console.warn(message_of(error));
  }
  return std::nullopt;
}

uvec2 picture_size(const SheetOptions& options) {
  uvec2 size = options.each.view.size.value_or(kSheetPicture);
  if (size.x == 0) size.x = std::max(size.y * kSheetPicture.x / kSheetPicture.y, 1U);
  if (size.y == 0) size.y = std::max(size.x * kSheetPicture.y / kSheetPicture.x, 1U);
  return size;
}

void check_sheet_size(const uvec2& size) {
  if (size.x <= kMaxSide && size.y <= kMaxSide) return;
  throw UsageError(
      {"sheet.size",
       fmt::format("the sheet would have {}x{} pixels, but a side can have at most {}", size.x, size.y, kMaxSide), "",
       "give a smaller --size or other --columns"});
}

void make_sheet(const SheetOptions& options) {
  const Console console(verbosity_of(options.each.tracing));
  check_render_spec(options.each);
  check_pictures(options.each.pictures);
  check_outputs(options.scenes, options.each.pictures, {});
  const SheetLayout layout(picture_size(options), static_cast<uint32_t>(options.scenes.size()), options.columns);
  check_sheet_size(layout.size());
  Image sheet{layout.size(), std::vector<vec3>(size_t{layout.size().x} * layout.size().y, kPaper)};
  const std::optional<fs::path> font = find_font();
  if (!font) console.warn("the sheet has no names because no font was found; install DejaVu Sans");
  const gpu::DeviceHandle device = open_device_of(options.each.tracing, console);
  Progress progress(console.is_quiet());
  size_t missing = 0;
  for (uint32_t i = 0; i < options.scenes.size(); ++i) {
    const std::string name = options.scenes[i].filename().string();
    progress.update(static_cast<double>(i) / static_cast<double>(options.scenes.size()), name);
    RenderSpec each = options.each;
    each.tracing.scene = options.scenes[i];
    each.view.size = layout.picture();
    const std::optional<Image> picture = render_cell(each, *device, console);
    if (!picture) ++missing;
    const Image blank{layout.picture(), std::vector<vec3>(size_t{layout.picture().x} * layout.picture().y, kNoPicture)};
    paste(picture.value_or(blank), layout.place(i), sheet);
    if (font) {
      paste(draw_name(name, *font, layout.picture().x), layout.place(i) + uvec2(0, layout.picture().y), sheet);
    }
  }
  progress.clear();
  write_picture(options.each.pictures.front(), sheet);
  if (missing == 0) return;
  throw InputError({"sheet.scenes.missing",
                    fmt::format("{} of {} {} not on the sheet", missing, count_of(options.scenes.size(), "scene"),
                                missing == 1 ? "is" : "are"),
                    options.each.pictures.front().string(), "see the warnings above"});
}

}  // namespace

Command add_thumbnail_command(CLI::App& program) {
  CLI::App& command = add_command(program, "thumbnail", "Write a small square picture of a scene, for file managers");
  const auto options = std::make_shared<RenderSpec>();
  options->view.size = uvec2(kThumbnailSide);
  options->view.frames_scene = true;
  OptionTable table(command);
  add_scene_argument(table, options->tracing);
  table.add_required("OUTPUT", "", "Picture to write. If the name has no extension, it is a PNG",
                     [=](const OptionValues& w) { options->pictures = {w.text()}; });
  table.add("SIZE", "", fmt::format("Width and height in pixels, 1 to {} [{}]", kMaxThumbnailSide, kThumbnailSide),
            [=](const OptionValues& w) { options->view.size = uvec2(w.whole(0, 1, kMaxThumbnailSide)); });
  return {&command, [options] { make_thumbnail(*options); }};
}

Command add_contact_sheet_command(CLI::App& program) {
  CLI::App& command =
      add_command(program, "contact-sheet", "Write one picture that shows many scenes, each with its name");
  const auto options = std::make_shared<SheetOptions>();
  options->each.view.frames_scene = true;
  OptionTable table(command);
  table.add_required_repeated("SCENES", "", "Scene files, in their order on the sheet",
                              [=](const OptionValues& w) { options->scenes.assign(w.all().begin(), w.all().end()); });
  table.add_required("-o,--output", "FILE", "Picture to write: .png, .jpg, .webp or .tif",
                     [=](const OptionValues& w) { options->each.pictures = {w.text()}; });
  table.add("--columns", "N", "Number of pictures per row [the sheet is approximately square]",
            [=](const OptionValues& w) { options->columns = w.whole(0, 1, kMaxColumns); });
  add_sample_options(table, options->each);
  add_view_options(table, options->each.view);
  command.get_option("--size")->description(
      fmt::format("Size of each picture in pixels; 640 alone is a width [{}x{}]", kSheetPicture.x, kSheetPicture.y));
  add_tracing_options(table, options->each.tracing);
  add_examples(command, {{"promin contact-sheet *.glb -o sheet.png", "shows all models in the folder"},
                         {"promin contact-sheet a.glb b.obj -o sheet.png --columns 2 --size 640x480",
                          "shows two larger models side by side"}});
  return {&command, [options] { make_sheet(*options); }};
}

}  // namespace promin::app
