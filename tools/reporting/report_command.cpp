// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/report_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <memory>
#include <sstream>

#include "bvh/builder.h"
#include "core/file.h"
#include "device/device.h"
#include "measure/meshes.h"
#include "promin/error.h"
#include "reporting/provenance.h"
#include "reporting/scene_names.h"
#include "reporting/session.h"
#include "tracing_options.h"

namespace promin::report {
namespace {

namespace fs = std::filesystem;

struct Section {
  const char* name;
  Json (*measure)(const Session& session);
};

/// In the page's order.
constexpr Section kSections[] = {{"kernels", measure_kernels},
                                 {"boxes", measure_boxes},
                                 {"frames", measure_frames},
                                 {"robustness", measure_robustness},
                                 {"specialisation", measure_specialisation},
                                 {"scaling", measure_scaling},
                                 {"rates", measure_rates}};

std::vector<std::string_view> section_names() {
  std::vector<std::string_view> names;
  for (const Section& section : kSections) names.emplace_back(section.name);
  return names;
}

/// Names with commas between them.
std::vector<std::string> read_sections(const app::OptionValues& words) {
  std::vector<std::string> sections;
  std::istringstream text(words.text());
  for (std::string name; std::getline(text, name, ',');) {
    sections.push_back(words.with({name}).choice(section_names()));
  }
  return sections;
}

void check_old_report(const fs::path& file) {
  const std::vector<std::byte> bytes = read_file(file);
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  const Json old = Json::parse(text, text + bytes.size(), nullptr, false);
  if (old.is_object() && old.value("format", 0) == kReportFormat) return;
  throw InputError({"no report of this version's format", file.string(), "give a report.json of promin-report"});
}

void make_folder(const fs::path& folder, const std::string& cure) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) throw RunError({"cannot make the folder", folder.string(), cure});
}

/// What would make the work useless, before it begins.
void check_options(const ReportOptions& options) {
  if (options.compare) check_old_report(*options.compare);
  for (auto scene = options.scenes.begin(); scene != options.scenes.end(); ++scene) {
    measure::open_scene(scene->string());
    if (std::any_of(options.scenes.begin(), scene,
                    [&](const fs::path& other) { return is_same_file(other, *scene); })) {
      throw UsageError({"a scene is given twice", scene->string(), "give each once"});
    }
  }
  make_folder(options.output, "give another with -o");
  if (options.pictures) make_folder(*options.pictures, "give another with --pictures");
}

void check_validation(const gpu::Device& device) {
  const uint64_t count = gpu::validation_message_count(device);
  if (count == 0) return;
  throw RunError({fmt::format("the Vulkan validation layers reported {} problems", count), gpu::info_of(device).name,
                  "report them as a bug in promin"});
}

void report(const ReportOptions& options) {
  check_options(options);
  const Session session(options);
  session.say(fmt::format("{} ({}), {} runs in turns", gpu::info_of(session.device()).name,
                          gpu::info_of(session.device()).type, session.runs()));
  Json json = {{"format", kReportFormat}};
  json["provenance"] = describe_run(session);
  for (const Section& section : kSections) {
    const std::vector<std::string>& only = options.only;
    if (only.empty() || std::find(only.begin(), only.end(), section.name) != only.end()) {
      json[section.name] = section.measure(session);
    }
  }
  check_validation(session.device());
  end_run(json);
  write_text_file(options.output / "runs.json", json.dump() + "\n");
}

}  // namespace

app::Command add_report_command(CLI::App& program) {
  const auto options = std::make_shared<ReportOptions>();
  app::OptionTable table(program);
  table.add_repeated(
      "SCENE", "SCENE", "Scenes: .gltf, .glb, .obj, .ply, .stl, .nff, wavy:N or needles:N [the project's own]",
      [=](const app::OptionValues& words) { options->scenes.assign(words.all().begin(), words.all().end()); });
  program.get_option("SCENE")->expected(-1);  // one or more
  table.add_required("-o,--output", "FOLDER", "Where runs.json goes",
                     [=](const app::OptionValues& words) { options->output = words.text(); });
  table.add("--compare", "OLD.json", "Refuse to begin where the page could not be compared with this report",
            [=](const app::OptionValues& words) { options->compare = words.text(); });
  table.add("--only", "SECTION[,SECTION]", fmt::format("Measure these alone: {}", fmt::join(section_names(), ", ")),
            [=](const app::OptionValues& words) { options->only = read_sections(words); });
  table.add("--builder", "NAME", fmt::format("Of rates: {} [sah]", fmt::join(builder_names(), ", ")),
            [=](const app::OptionValues& words) { options->builder = words.choice(builder_names()); });
  table.add("--side", "N", "Pixels each way of the camera rays' picture where rays are cast [512; 96 with --quick]",
            [=](const app::OptionValues& words) { options->side = words.whole(0, 1, 4096); });
  table.add("--pictures", "FOLDER", "Write the pictures of frames here, for other programs to judge",
            [=](const app::OptionValues& words) { options->pictures = words.text(); });
  table.add("--commit", "NAME", "What the report shall say of the sources' commit",
            [=](const app::OptionValues& words) { options->commit = words.text(); });
  app::add_device_option(table, options->device);
  table.add("--runs", "N", "Timed runs of each after a warm-up, in turns [20; 3 with --quick]",
            [=](const app::OptionValues& words) { options->runs = words.whole(0, 1, 1000); });
  table.add_flag("--quick", "Few runs and small sizes: whether it works, not how fast it is", options->is_quick);
  return {&program, [options] { report(*options); }};
}

}  // namespace promin::report
