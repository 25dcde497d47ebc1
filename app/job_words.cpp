// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "job_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "arguments.h"
#include "core/file.h"
#include "promin/error.h"
#include "sources_hash.h"

namespace promin::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Of the file that keeps arguments.
constexpr int kFormat = 1;

/// How a job treats an option. An option without a row is ordinary: it affects bits, is not a file, and is stored.
struct OptionOfJobs {
  std::string_view name;
  /// Whether the manifest stores its words. Files that SCENE and others name are stored by their hashes.
  bool is_in_manifest = true;
  /// Whether it is stored by its absolute path, because the job may be planned again in any folder.
  bool names_file = false;
  /// False if each process that works on a job chooses its own value.
  bool is_kept = true;
  /// A word that is equivalent to not giving the option, for every scene.
  std::string_view default_word = "";
  /// Where it is chosen instead, if it cannot be an argument of a job.
  const char* said_elsewhere = nullptr;
};
constexpr const char* kMergeSays = "the files are named when the pieces are merged";
constexpr OptionOfJobs kOptionsOfJobs[] = {
    {.name = "SCENE", .is_in_manifest = false, .names_file = true},
    {.name = "RAYS.npy", .is_in_manifest = false, .names_file = true},
    {.name = "--bvh", .is_in_manifest = false, .names_file = true},
    {.name = "--compression", .default_word = "zip"},
    {.name = "--depth", .default_word = "ray"},
    {.name = "--environment", .names_file = true},
    {.name = "--environment-intensity", .default_word = "1"},
    {.name = "--environment-rotation", .default_word = "0"},
    {.name = "--error-in", .default_word = "linear"},
    {.name = "--exposure", .default_word = "auto"},
    {.name = "--filter", .default_word = "box"},
    {.name = "--light-rotation", .default_word = "0"},
    {.name = "--path", .names_file = true},
    {.name = "--output", .is_in_manifest = false, .is_kept = false, .said_elsewhere = kMergeSays},
    {.name = "--offsets", .is_in_manifest = false, .is_kept = false, .said_elsewhere = kMergeSays},
    {.name = "--job", .is_in_manifest = false, .is_kept = false, .said_elsewhere = "the folder is given separately"},
    {.name = "--piece",
     .is_in_manifest = false,
     .is_kept = false,
     .said_elsewhere = "they are chosen when pieces are made"},
    {.name = "--device",
     .is_in_manifest = false,
     .is_kept = false,
     .said_elsewhere = "it is chosen when pieces are made"},
    {.name = "--threads", .is_in_manifest = false, .is_kept = false},
    {.name = "--stats", .is_in_manifest = false, .is_kept = false},
    {.name = "--quiet", .is_in_manifest = false, .is_kept = false},
    {.name = "--verbose", .is_in_manifest = false, .is_kept = false},
    {.name = "--builder", .is_in_manifest = false},
    {.name = "--features", .is_in_manifest = false},
    {.name = "--pieces", .is_in_manifest = false},
    {.name = "--root", .is_in_manifest = false, .names_file = true},
    {.name = "--repeat", .is_in_manifest = false},
    {.name = "--quality", .default_word = "normal"},
    {.name = "--shading", .default_word = "full"},
    {.name = "--spp", .default_word = "8"},
    {.name = "--tiles", .is_in_manifest = false}};

const OptionOfJobs& option_of_jobs(std::string_view name) {
  static constexpr OptionOfJobs kOrdinary;
  const auto* const row = std::ranges::find(kOptionsOfJobs, name, &OptionOfJobs::name);
  return row != std::end(kOptionsOfJobs) ? *row : kOrdinary;
}

bool is_default(const OptionOfJobs& option, const std::vector<std::string>& words) {
  return !option.default_word.empty() && words.size() == 1 && words.front() == option.default_word;
}

}  // namespace

jobs::Manifest begin_manifest(std::string_view kind, const GivenOptions& given) {
  jobs::Manifest manifest;
  manifest.kind = kind;
  manifest.options = {{"version", PROMIN_VERSION}, {"program", std::string(kSourcesHash)}};
  for (const auto& [name, words] : given) {
    const OptionOfJobs& option = option_of_jobs(name);
    if (!option.is_in_manifest || is_default(option, words)) continue;
    const std::string value = words.empty() ? "given" : fmt::format("{}", fmt::join(words, " "));
    manifest.options.emplace_back(name, option.names_file ? fs::path(value).filename().string() : value);
  }
  return manifest;
}

void add_scene_files(jobs::Manifest& manifest, const std::vector<SourceFile>& sources) {
  for (const SourceFile& source : sources) {
    if (!source.stamp) continue;
    manifest.files.push_back(jobs::describe_input(source.file));
    if (stamp_of(source.file) == source.stamp) continue;
    throw InputError({"file.changed", "the file changed while it was read", source.file.string(), "try again"});
  }
}

std::vector<std::string> keep_arguments(const CLI::App& command) {
  std::vector<std::string> arguments;
  for (const auto& [name, words] : given_options(command)) {
    const OptionOfJobs& option = option_of_jobs(name);
    if (!option.is_kept || is_default(option, words)) continue;
    if (name.starts_with('-')) arguments.push_back(name);
    for (const std::string& word : words) {
      arguments.push_back(option.names_file ? fs::absolute(word).lexically_normal().string() : word);
    }
  }
  return arguments;
}

fs::path arguments_file(const jobs::Job& job) {
  return job.folder() / "command.json";
}

void write_arguments(const jobs::Job& job, const std::vector<std::string>& arguments) {
  const Json json = {{"promin_command", kFormat}, {"kind", job.manifest().kind}, {"arguments", arguments}};
  write_text_file(arguments_file(job), json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::optional<std::vector<std::string>> read_arguments(const jobs::Job& job) {
  const Json json = Json::parse(std::ifstream(arguments_file(job)), nullptr, false);
  try {
    if (json.is_object() && json.at("promin_command") == kFormat && json.at("kind") == job.manifest().kind) {
      return json.at("arguments").get<std::vector<std::string>>();
    }
  } catch (const nlohmann::json::exception&) {
  }
  return {};
}

void check_asks_for_work(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (word != "-h" && word != "--help" && word != "--version") continue;
    throw UsageError({"job.argument.wrong", word + " cannot run as a job", "", "leave it out"});
  }
}

void check_is_kept(const GivenOptions& given) {
  for (const auto& [option, words] : given) {
    const char* const why = option_of_jobs(option).said_elsewhere;
    if (why == nullptr) continue;
    throw UsageError(
        {"job.argument.wrong", option + " is not an argument of a job", "", std::string("leave it out; ") + why});
  }
}

}  // namespace promin::app
