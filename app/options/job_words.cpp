// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/job_words.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <iterator>

#include "options/arguments.h"
#include "options/cast_options.h"
#include "options/render_options.h"
#include "options/spec_options.h"
#include "options/tracing_options.h"
#include "promin/error.h"
#include "work/jobs/spec_job.h"

namespace promin::app {
namespace {

/// An option that is not an argument of jobs, and the place where it is chosen instead.
struct SaidElsewhere {
  std::string_view option;
  std::string_view where;
};
constexpr std::string_view kMergeSays = "the files are named when the pieces are merged";
constexpr SaidElsewhere kSaidElsewhere[] = {{"--output", kMergeSays},
                                            {"--offsets", kMergeSays},
                                            {"--job", "the folder is given separately"},
                                            {"--piece", "they are chosen when pieces are made"},
                                            {"--device", "it is chosen when pieces are made"}};

/// Throws UsageError for arguments of a job that request help or the version.
void check_asks_for_work(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (word != "-h" && word != "--help" && word != "--version") continue;
    throw UsageError({"job.argument.wrong", word + " cannot be part of a job", "", "remove it"});
  }
}

/// Throws UsageError for options that are not arguments of jobs.
void check_is_kept(const CLI::App& command) {
  for (const auto& [option, words] : given_options(command)) {
    const auto* const found = std::ranges::find(kSaidElsewhere, option, &SaidElsewhere::option);
    if (found == std::end(kSaidElsewhere)) continue;
    throw UsageError({"job.argument.wrong", option + " is not an argument of a job", "",
                      "remove it, because " + std::string(found->where)});
  }
}

/// Returns the specification that these arguments of the command describe.
template <typename Spec>
Spec read_words(const std::string& name, void (*add_options)(CLI::App&, Spec&),
                const std::vector<std::string>& arguments) {
  check_asks_for_work(arguments);
  CLI::App program("", "promin");
  Spec spec;
  CLI::App& command = add_command(program, name, "");
  add_spec_option(command, spec);
  add_options(command, spec);
  std::vector<const char*> words = {"promin", name.c_str()};
  for (const std::string& word : arguments) words.push_back(word.c_str());
  static_cast<void>(parse_arguments(program, static_cast<int>(words.size()), words.data()));
  check_is_kept(command);
  static_cast<void>(verbosity_of(spec.tracing));
  return spec;
}

}  // namespace

std::unique_ptr<PlannedJob> plan_job_of_words(const std::string& kind, const std::vector<std::string>& arguments,
                                              const std::filesystem::path& folder, const Messages& messages,
                                              std::shared_ptr<RaySource> rays) {
  return plan_job_of_kind(
      kind, [&] { return read_words(kind, add_render_options, arguments); },
      [&] { return read_words(kind, add_cast_options, arguments); }, folder, messages, std::move(rays));
}

}  // namespace promin::app
