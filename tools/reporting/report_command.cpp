// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/report_command.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <memory>

#include "core/file.h"
#include "device/device.h"
#include "promin/error.h"
#include "promin/load_scene.h"
#include "reporting/provenance.h"
#include "reporting/scene_names.h"
#include "reporting/scripts.h"
#include "reporting/session.h"
#include "reporting/write_csv.h"

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
                                 {"peers", measure_peers}};

void check_old_report(const fs::path& file) {
  const std::vector<std::byte> bytes = read_file(file);
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  const Json old = Json::parse(text, text + bytes.size(), nullptr, false);
  if (old.is_object() && old.value("format", 0) == kReportFormat) return;
  throw InputError({"no report of this version's format", file.string(), "give a report.json of promin-report"});
}

/// What would make the work useless, before it begins.
void check_options(const ReportOptions& options) {
  if (options.compare) check_old_report(*options.compare);
  for (auto scene = options.scenes.begin(); scene != options.scenes.end(); ++scene) {
    load_scene(*scene);
    if (std::any_of(options.scenes.begin(), scene,
                    [&](const fs::path& other) { return is_same_file(other, *scene); })) {
      throw UsageError({"a scene is given twice", scene->string(), "give each once"});
    }
  }
  std::error_code error;
  fs::create_directories(options.output, error);
  if (error || !fs::is_directory(options.output)) {
    throw RunError({"cannot make the folder", options.output.string(), "give another with -o"});
  }
}

void check_validation(const gpu::Device& device) {
  const uint64_t count = gpu::validation_message_count(device);
  if (count == 0) return;
  throw RunError({fmt::format("the Vulkan validation layers reported {} problems", count), gpu::info_of(device).name,
                  "report them as a bug of promin"});
}

void report(const ReportOptions& options) {
  check_options(options);
  const Session session(options);
  session.say(fmt::format("{} ({}), {} runs in turns", gpu::info_of(session.device()).name,
                          gpu::info_of(session.device()).type, session.runs()));
  Json json = {{"format", kReportFormat}};
  json["provenance"] = describe_run(session);
  for (const Section& section : kSections) json[section.name] = section.measure(session);
  check_validation(session.device());
  end_run(json);
  write_csv_files(json, options.output);
  drop_values(json);
  write_text_file(options.output / "report.json", json.dump(1) + "\n");
  make_page(session);
}

}  // namespace

app::Command add_report_command(CLI::App& program) {
  const auto options = std::make_shared<ReportOptions>();
  app::OptionTable table(program);
  table.add_repeated(
      "SCENE", "SCENE", "Scenes: .gltf, .glb or .obj [the project's own]",
      [=](const app::OptionValues& words) { options->scenes.assign(words.all().begin(), words.all().end()); });
  program.get_option("SCENE")->expected(-1);  // one or more
  table.add_required("-o,--output", "FOLDER", "Where report.json, CSV files and report.html go",
                     [=](const app::OptionValues& words) { options->output = words.text(); });
  table.add("--compare", "OLD.json", "Say what changed since this report beyond noise",
            [=](const app::OptionValues& words) { options->compare = words.text(); });
  table.add("--device", "NAME|INDEX", "As `promin render` takes it",
            [=](const app::OptionValues& words) { options->device = words.text(); });
  table.add("--runs", "N", "Timed runs of each after a warm-up, in turns [20; 3 with --quick]",
            [=](const app::OptionValues& words) { options->runs = words.whole(0, 1, 1000); });
  table.add_flag("--quick", "Few runs and small sizes: whether it works, not how fast it is", options->is_quick);
  return {&program, [options] { report(*options); }};
}

}  // namespace promin::report
