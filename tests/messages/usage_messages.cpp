// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <CLI/App.hpp>
#include <cstdlib>
#include <filesystem>

#include "app/cli_fixture.h"
#include "commands/bvh_commands.h"
#include "commands/cast_command.h"
#include "commands/compare_command.h"
#include "commands/devices_command.h"
#include "commands/info_command.h"
#include "commands/merge_command.h"
#include "commands/render_command.h"
#include "commands/sheet_commands.h"
#include "messages/message_cases.h"
#include "output/run_program.h"
#include "support/moving_gltf.h"
#include "work/pictures/film_file.h"

namespace promin {
namespace {

using Words = std::vector<std::string>;

/// A code, and the words of the command line that gives it.
struct WrongUsage {
  std::string_view code;
  Words words;
};

const WrongUsage kWrongUsages[] = {
    {"usage.command.unknown", {"rendr"}},
    {"usage.command.unknown", {"rendr", "square.gltf", "-o", "a.png"}},
    {"usage.command.unknown", {"paint"}},
    {"usage.option.value", {"render", "square.gltf", "--aov", "depth,normel"}},
    {"usage.option.value", {"render", "square.gltf", "--filter", "bx"}},
    {"usage.command.unknown", {"diff", "a.png", "b.png"}},
    {"usage.option.unknown", {"render", "square.gltf", "--denoise"}},
    {"usage.option.unknown", {"render", "square.gltf", "--dice", "1"}},
    {"usage.argument.unexpected", {"square.gltf", "x.png"}},
    {"usage.option.unknown", {"--spp", "3"}},
    {"usage.words.wrong", {"render"}},
    {"usage.words.wrong", {"info"}},
    {"usage.argument.unexpected", {"devices", "all"}},
    {"usage.option.needs", {"render", "square.gltf", "--skip-existing"}},
    {"usage.options.contradict", {"render", "square.gltf", "-o", "a.png", "--skip-existing", "--exposure", "average"}},
    {"usage.option.unknown", {"render", "square.gltf", "-o", "a.exr", "--spq", "3"}},
    {"usage.option.unknown", {"render", "square.gltf", "--target-eror=1"}},
    {"usage.option.unknown", {"render", "square.gltf", "--nothing-like-it"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--target-error", "0"}},
    {"usage.options.contradict", {"render", "square.gltf", "-o", "a.exr", "--target-error", "0.1", "--spp", "4"}},
    {"usage.options.contradict", {"render", "square.gltf", "-o", "a.exr", "--target-error", "0.1", "--spp", "1"}},
    {"usage.options.contradict", {"render", "square.gltf", "-o", "a.exr", "--time-limit", "1", "--shading", "uv"}},
    {"usage.options.contradict", {"render", "square.gltf", "-o", "a.exr", "--time-limit", "1", "--repeat", "2"}},
    {"usage.option.needs", {"render", "square.gltf", "-o", "a.exr", "--min-spp", "8"}},
    {"usage.option.needs", {"render", "square.gltf", "-o", "a.exr", "--error-in", "linear"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--target-error", "0.1", "--error-in", "log"}},
    {"usage.options.contradict",
     {"render", "square.gltf", "-o", "a.png", "--target-error", "0.1", "--error-in", "display", "--exposure",
      "average"}},
    {"usage.options.contradict", {"render", "square.gltf", "-o", "a.exr", "--aov", "error", "--shading", "uv"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--target-error", "0.1", "--min-spp", "12"}},
    {"usage.options.range",
     {"render", "square.gltf", "-o", "a.exr", "--target-error", "0.1", "--min-spp", "16", "--max-spp", "8"}},
    {"usage.option.unknown", {"render", "square.gltf", "--spq=3"}},
    {"usage.argument.unexpected", {"render", "square.gltf", "triangle.obj", "-o", "a.exr"}},
    {"output.extension", {"render", "square.gltf", "-o", "a.bmp"}},
    {"output.alpha.none", {"render", "square.gltf", "-o", "a.jpg", "--alpha"}},
    {"output.alpha.none", {"render", "square.gltf", "-o", "a.hdr", "--alpha"}},
    {"output.standard.taken", {"render", "square.gltf", "-o", "-", "-o", "-"}},
    {"output.standard.taken", {"render", "square.gltf", "-o", "-", "--job", "j"}},
    {"usage.option.needs", {"render", "square.gltf", "-o", "a.jpg", "--aov", "depth"}},
    {"output.extension", {"render", "square.gltf", "-o", "a"}},
    {"output.twice", {"render", "square.gltf", "-o", "a.exr", "-o", "./a.exr"}},
    {"output.input", {"render", "square.gltf", "-o", "a.exr", "--stats", "square.gltf"}},
    {"output.twice", {"render", "square.gltf", "-o", "a.exr", "--stats", "a.exr"}},
    {"usage.option.few", {"render", "square.gltf", "-o", "a.exr", "--spp"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--spp", "0"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "-s", "65537"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "-s", "4294967297"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "-s", "-1"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "-s", "2x"}},
    {"usage.option.few", {"render", "square.gltf", "-o", "a.exr", "--size"}},
    {"usage.option.value", {"render", "square.gltf", "--size", "large", "-o", "a.exr"}},
    {"usage.option.value", {"render", "square.gltf", "--size", "640:480", "-o", "a.exr"}},
    {"usage.option.value", {"render", "square.gltf", "--size", "fulhd", "-o", "a.exr"}},
    {"usage.option.value", {"render", "square.gltf", "--size", "64x48x32"}},
    {"usage.option.unknown", {"square.gltf", "--gpu", "0"}},
    {"usage.option.value", {"square.gltf", "--threads", "0"}},
    {"usage.option.few", {"render", "square.gltf", "-o", "a.exr", "--eye", "0", "0", "--spp", "4"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--near", "-inf"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--exposure", "foo"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--fps", "foo"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--size", "64", "0"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--max-depth", "1001"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--repeat", "0"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--crop", "5", "0", "5", "9"}},
    {"view.crop.outside", {"render", "square.gltf", "-o", "a.exr", "--crop", "0", "0", "1281", "9"}},
    {"animation.unknown", {"render", "walk.gltf", "-o", "a.exr", "--time", "1", "--animation", "run"}},
    {"animation.unknown", {"render", "walk.gltf", "-o", "a.exr", "--animation", "7"}},
    {"animation.missing", {"render", "square.gltf", "-o", "a.exr", "--animation", "run"}},
    {"usage.option.needs", {"render", "walk.gltf", "-o", "a.exr", "--loop"}},
    {"usage.option.value", {"render", "walk.gltf", "-o", "a.exr", "--time", "-1"}},
    {"usage.option.value", {"render", "walk.gltf", "-o", "a.exr", "--time", "nan"}},
    {"usage.option.value", {"info", "walk.gltf", "--animation", ""}},
    {"usage.options.contradict", {"info", "walk.gltf", "--animation", "all", "--animation", "walk"}},
    {"camera.unknown", {"render", "square.gltf", "-o", "a.exr", "--camera", "back"}},
    {"camera.unknown", {"render", "square.gltf", "-o", "a.exr", "--camera", "2"}},
    {"camera.missing", {"render", "triangle.obj", "-o", "a.exr", "--camera", "0"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--fov", "180"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--near", "-1"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--eye", "0", "nan", "0"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--eye", "0", "inf", "0"}},
    {"camera.direction", {"render", "square.gltf", "-o", "a.exr", "--direction", "0", "2", "0", "--up", "y"}},
    {"camera.point.eye", {"render", "square.gltf", "-o", "a.exr", "--eye", "1", "2", "3", "--look-at", "1", "2", "3"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--look", "0", "2", "0"}},
    {"usage.options.contradict",
     {"render", "square.gltf", "-o", "a.exr", "--look-at", "0", "2", "0", "--direction", "1", "2", "3"}},
    {"usage.options.contradict", {"render", "square.gltf", "-o", "a.exr", "--from", "left", "--eye", "0", "2", "0"}},
    {"usage.options.contradict", {"render", "square.gltf", "-o", "a.exr", "--from", "left", "--camera", "0"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--from", "lefty"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--fit", "1.5"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--zoom", "0"}},
    {"usage.option.few", {"render", "square.gltf", "-o", "a.exr", "--up", "north"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--builder", "none"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--device", ""}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--features", "few"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--light", "lamp"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--light", "auto"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--framing", "back"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--tone-mapping", "filmic"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--texture-memory", "0"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--exposure", "bright"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--exposure", "nan"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--background", "-1", "0", "0"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--background", "0", "0", "inf"}},
    {"usage.option.value", {"render", "square.gltf", "--background", "sky", "-o", "a.exr"}},
    {"usage.option.value", {"render", "square.gltf", "--background", "#12345", "-o", "a.exr"}},
    {"usage.option.value", {"render", "square.gltf", "--background", "whit", "-o", "a.exr"}},
    {"usage.option.value", {"render", "square.gltf", "--background", "transparent", "-o", "a.exr"}},
    {"usage.option.value", {"render", "square.gltf", "--background", "255", "0", "0", "-o", "a.exr"}},
    {"usage.option.value", {"render", "square.gltf", "--background", "linear:1,2", "-o", "a.exr"}},
    {"usage.option.value", {"render", "square.gltf", "--background", "linear:1,x,2", "-o", "a.exr"}},
    {"usage.option.value", {"render", "square.gltf", "--background", "envronment", "-o", "a.exr"}},
    {"usage.option.value", {"render", "square.gltf", "--exposure", "averge", "-o", "a.exr"}},
    {"usage.options.contradict", {"render", "square.gltf", "-o", "a.png", "--alpha", "--background", "1", "1", "1"}},
    {"usage.option.needs", {"render", "square.gltf", "-o", "a.exr", "--dither"}},
    {"usage.options.contradict", {"render", "square.gltf", "-o", "a.exr", "--aov", "direct", "--shading", "normals"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--target-error", "1/0"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--target-error", "1/65537"}},
    {"usage.option.value", {"render", "square.gltf", "-o", "a.exr", "--target-error", "3/2"}},
    {"usage.option.few", {"render", "square.gltf", "-o", "a.exr", "--background", "0", "0"}},
    {"usage.options.contradict", {"render", "square.gltf", "-o", "a.exr", "--quiet", "-v"}},
    {"usage.words.wrong", {"render", "square.gltf", "-o", "a.exr", "--quiet=perhaps"}},
    {"usage.option.needs", {"cast", "square.gltf", "rays.npy", "--all", "-o", "a.npy"}},
    {"usage.option.needs", {"cast", "square.gltf", "rays.npy", "--offsets", "o.npy", "-o", "a.npy"}},
    {"usage.option.required", {"cast", "square.gltf", "rays.npy"}},
    {"usage.options.contradict", {"cast", "square.gltf", "rays.npy", "--any", "--count", "-o", "a.npy"}},
    {"usage.options.contradict", {"cast", "square.gltf", "rays.npy", "--job", "j", "--repeat", "2", "-o", "a.npy"}},
    {"usage.options.contradict", {"cast", "square.gltf", "rays.npy", "--job", "j", "--piece", "0/2", "-o", "a.npy"}},
    {"usage.option.value", {"cast", "square.gltf", "rays.npy", "-o", "a.npy", "-o", "b.npy"}},
    {"output.extension", {"cast", "square.gltf", "rays.npy", "-o", "a.txt"}},
    {"output.input", {"cast", "square.gltf", "rays.npy", "-o", "rays.npy"}},
    {"usage.options.contradict", {"render", "square.gltf", "--job", "j", "--exposure", "average"}},
    {"usage.options.contradict", {"render", "square.gltf", "--bvh", "a.pbvh", "--builder", "sah"}},
    {"usage.options.contradict", {"render", "square.gltf", "--path", "p.json", "--camera", "0"}},
    {"usage.options.contradict", {"render", "square.gltf", "--quality", "draft", "--spp", "4"}},
    {"usage.options.contradict", {"render", "square.gltf", "--job", "j", "--piece", "0/2", "-o", "a.exr"}},
    {"usage.option.needs", {"render", "square.gltf", "--piece", "0/2"}},
    {"usage.option.value", {"render", "square.gltf", "--job", "j", "--piece", "2"}},
    {"animation.missing", {"render", "square.gltf", "--frames", "0-3"}},
    {"animation.missing", {"render", "square.gltf", "--path", "path.json", "--animation", "0"}},
    {"usage.option.needs", {"render", "walk.gltf", "--fps", "stored"}},
    {"usage.options.contradict", {"render", "walk.gltf", "--frames", "0-3", "--time", "1"}},
    {"usage.options.contradict", {"render", "walk.gltf", "--fps", "12", "--animation", "none"}},
    {"usage.options.contradict", {"render", "walk.gltf", "--frames", "0-3", "--bvh", "a.pbvh"}},
    {"usage.options.contradict", {"render", "walk.gltf", "--frames", "0-3", "--exposure", "average"}},
    {"usage.options.contradict", {"render", "walk.gltf", "--frames", "0-3", "--explain", "1", "1"}},
    {"output.frames.one", {"render", "walk.gltf", "--frames", "0-3", "-o", "a.exr"}},
    {"usage.options.contradict", {"render", "walk.gltf", "--frames", "0-3", "-o", "a.png", "--skip-existing"}},
    {"output.standard.taken", {"render", "walk.gltf", "--frames", "0-3", "-o", "-"}},
    {"output.standard.taken", {"render", "walk.gltf", "--turntable", "4", "-o", "-"}},
    {"path.frame.missing", {"render", "walk.gltf", "--turntable", "4", "--frames", "3-4"}},
    {"usage.option.value", {"render", "walk.gltf", "--turntable", "1"}},
    {"usage.options.contradict", {"render", "walk.gltf", "--turntable", "4", "--path", "path.json"}},
    {"usage.option.needs", {"render", "walk.gltf", "--shutter", "0.5"}},
    {"usage.option.needs", {"render", "walk.gltf", "--aov", "motion"}},
    {"usage.options.contradict", {"render", "walk.gltf", "--fps", "9", "--shutter", "0.5", "--target-error", "0.1"}},
    {"film.frames.many", {"render", "long.gltf", "--fps", "1000"}},
    {"film.fps.many", {"render", "walk.gltf", "--fps", "60", "-o", "a.gif"}},
    {"film.fps.missing", {"render", "square.gltf", "--path", "path.json", "--fps", "stored", "-o", "a.webm"}},
    {"output.film.number", {"render", "square.gltf", "--fps", "24", "-o", "a.####.mp4"}},
    {"output.alpha.none", {"render", "square.gltf", "--fps", "24", "-o", "a.mp4", "--alpha"}},
    {"usage.option.value", {"render", "square.gltf", "--frames", "3-0"}},
    {"usage.option.needs", {"render", "square.gltf", "--depth", "plane"}},
    {"usage.option.value", {"render", "square.gltf", "--lights-off", "x"}},
    {"light.unknown", {"render", "square.gltf", "-o", "a.exr", "--lights-off", "7"}},
    {"camera.eye.middle", {"render", "triangle.obj", "-o", "a.exr", "--eye", "0", "0", "0"}},
    {"view.pixel.outside", {"render", "square.gltf", "--size", "8x8", "--explain", "9", "9"}},
    {"usage.option.value", {"info", "square.gltf", "--root", ""}},
    {"usage.option.value", {"info", "square.gltf", "--variant", ""}},
    {"usage.option.needs", {"compare", "a.exr", "b.exr", "--fail-percent", "1"}},
    {"picture.pair.spaces", {"compare", "a.exr", "a.png"}},
    {"picture.pair.channels", {"compare", "a.exr", "deep.exr"}},
    {"picture.pair.sizes", {"compare", "a.exr", "small.exr"}},
    {"picture.pair.differs", {"compare", "a.exr", "b.exr", "--fail", "0.25"}},
    {"output.foreign", {"square.gltf"}},
    {"sheet.size", {"contact-sheet", "square.gltf", "-o", "a.png", "--size", "32768", "32768"}},
    {"path.frame.missing", {"render", "square.gltf", "--path", "path.json", "--frames", "4-5", "-o", "a.####.exr"}},
    {"path.frames.many", {"render", "square.gltf", "--path", "path.json", "--fps", "1000", "-o", "a.####.exr"}},
    {"output.frames.one", {"render", "square.gltf", "--path", "path.json", "-o", "a.exr"}},
    {"path.frame.choice", {"render", "square.gltf", "--path", "both.json", "-o", "a.####.exr"}},
    {"path.frames.missing", {"render", "square.gltf", "--path", "empty.json", "-o", "a.####.exr"}},
    {"path.time.order", {"render", "square.gltf", "--path", "order.json", "-o", "a.####.exr"}},
    {"path.frame.wrong", {"render", "square.gltf", "--path", "old.json", "-o", "a.####.exr"}},
    {"camera.direction", {"render", "square.gltf", "--path", "still.json", "-o", "a.####.exr"}},
    {"camera.aspect", {"render", "narrow.gltf", "-o", "a.exr"}},
    {"file.missing", {"render", "none.gltf", "-o", "a.exr"}},
};

const WrongUsage kWrongUsagesOfTrees[] = {
    {"usage.command.missing", {"--"}},
    {"output.extension", {"build", "square.gltf", "-o", "a.bin"}},
};

/// Runs a program in this process.
void run(const std::string& program, std::initializer_list<app::Command (*)(CLI::App& program)> commands,
         const Words& words) {
  std::vector<const char*> all = {program.c_str()};
  for (const std::string& word : words) all.push_back(word.c_str());
  app::run_command(program, "", commands, static_cast<int>(all.size()), all.data());
}

/// Writes a camera path with these frames.
void write_path(const std::string& file, int version, const std::string& frames) {
  write_case(file, R"({"format": "promin camera path", "version": )" + std::to_string(version) + R"(, "frames": [)" +
                       frames + "]}");
}

std::string frame(const std::string& time, const std::string& look, const std::string& more) {
  return R"({"time_s": )" + time + R"(, "eye": [0, 0, 4], "up": [0, 1, 0], "look": )" + look + more + "}";
}

void write_scenes() {
  write_case("triangle.obj", kTriangleObj);
  write_case("square.gltf", kSquareGltf);
  write_case("square.png", "a file of somebody");
  GltfBuilder walk = triangle_gltf();
  test::animate(walk, 0, "/nodes/0/translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "VEC3");
  test::animate(walk, 1, "/nodes/0/scale", {0, 1}, {1, 1, 1, 2, 2, 2}, "VEC3");
  walk.json["animations"][0]["name"] = "walk";
  write_case("walk.gltf", walk.text());
  GltfBuilder slow = triangle_gltf();
  test::animate(slow, 0, "/nodes/0/translation", {0, 1e6F}, {0, 0, 0, 1, 0, 0}, "VEC3");
  write_case("long.gltf", slow.text());
  std::string narrow = kSquareGltf;
  const std::string yfov = "\"yfov\"";
  write_case("narrow.gltf", narrow.replace(narrow.find(yfov), yfov.size(), "\"aspectRatio\": 1e-6, " + yfov));
}

void write_pictures() {
  const Image picture = {{4, 2}, std::vector<vec3>(8, vec3(0.5F))};
  write_image("a.exr", picture);
  write_image("a.png", picture);
  write_image("b.exr", {{4, 2}, std::vector<vec3>(8, vec3(1.0F))});
  write_image("small.exr", {{2, 2}, std::vector<vec3>(4, vec3(0.5F))});
  const std::vector<Channel> depth = {{"Z", false, std::vector<uint32_t>(8)}};
  write_image("deep.exr", picture, {}, std::nullopt, depth);
}

void write_paths() {
  const std::string ahead = "[0, 0, -1]";
  const std::string lens = R"(, "fov_deg": 40)";
  write_path("path.json", 1, frame("0", ahead, lens) + ", " + frame("100000", ahead, lens));
  write_path("both.json", 1, frame("0", ahead, lens + R"(, "ymag": 1)"));
  write_path("empty.json", 1, "");
  write_path("order.json", 1, frame("1", ahead, lens) + ", " + frame("1", ahead, lens));
  write_path("old.json", 1, R"({"time_s": 0, "eye": [0, 0, 4], "up": [0, 1, 0], "fov_deg": 40})");
  write_path("still.json", 1, frame("0", "[0, 0, 0]", lens));
}

/// Sets the folders in which programs are found, and restores them.
class ProgramFolders {
 public:
  explicit ProgramFolders(const char* folders) : old_(std::getenv("PATH")) { setenv("PATH", folders, 1); }
  ~ProgramFolders() { setenv("PATH", old_.c_str(), 1); }
  ProgramFolders(const ProgramFolders&) = delete;
  ProgramFolders& operator=(const ProgramFolders&) = delete;

 private:
  std::string old_;
};

std::vector<MessageCase> cases_of_films() {
  return {{"film.ffmpeg.missing",
           [] {
             const ProgramFolders none("/nowhere");
             work::check_film("a.mp4", 24.0);
           }},
          {"film.encode", [] {
             write_case("ffmpeg", "#!/bin/sh\necho 'Unknown encoder' >&2\nexit 1\n");
             std::filesystem::permissions("ffmpeg", std::filesystem::perms::all);
             const ProgramFolders here(".");
             work::FilmFile film("a.mp4", {.size = {2, 2}, .fps = 24.0, .frame_count = 1});
             film.commit();
           }}};
}

}  // namespace

std::vector<MessageCase> cases_of_usage() {
  std::vector<MessageCase> cases;
  for (const auto& [code, words] : kWrongUsages) {
    cases.push_back({code, [&words = words] {
                       write_scenes();
                       if (words[0] == "compare") write_pictures();
                       if (std::ranges::find(words, "--path") != words.end()) write_paths();
                       run("promin",
                           {app::add_render_command, app::add_merge_command, app::add_cast_command,
                            app::add_compare_command, app::add_info_command, app::add_thumbnail_command,
                            app::add_contact_sheet_command, app::add_devices_command},
                           words);
                     }});
  }
  for (const auto& [code, words] : kWrongUsagesOfTrees) {
    cases.push_back({code, [&words = words] {
                       write_scenes();
                       run("promin-bvh", {app::add_build_command, app::add_verify_command}, words);
                     }});
  }
  for (const MessageCase& film : cases_of_films()) cases.push_back(film);
  return cases;
}

}  // namespace promin
