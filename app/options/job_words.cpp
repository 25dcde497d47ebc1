// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/job_words.h"

#include <CLI/App.hpp>
#include <span>
#include <string_view>

#include "options/arguments.h"
#include "options/cast_options.h"
#include "options/render_options.h"
#include "options/spec_options.h"
#include "promin/error.h"
#include "work/jobs/planned_job.h"
#include "work/jobs/spec_job.h"
#include "work/spec/spec_json.h"

namespace promin::app {
namespace {

/// An option that is not an argument of jobs, and the place where it is chosen instead.
struct SaidElsewhere {
  std::string_view option;
  std::string_view where;
};
constexpr std::string_view kMergeSays = "the files are named when the pieces are merged";
constexpr std::string_view kMakerSays = "each process that makes pieces chooses it";
constexpr SaidElsewhere kOutputs[] = {{"--output", kMergeSays}, {"--offsets", kMergeSays}};
constexpr SaidElsewhere kSaidElsewhere[] = {{"--job", "the folder is given separately"},
                                            {"--piece", "they are chosen when pieces are made"},
                                            {"--device", kMakerSays},
                                            {"--threads", kMakerSays},
                                            {"--stats", "statistics describe a run without a job"},
                                            {"--repeat", "each piece is made once"}};

/// Throws UsageError for arguments of a job that request help or the version.
void check_asks_for_work(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (word != "-h" && word != "--help" && word != "--version") continue;
    throw UsageError({"job.argument.wrong", word + " cannot be part of a job", "", "remove it"});
  }
}

/// Throws UsageError for the first of these options that is given.
void refuse_given(const CLI::App& command, std::span<const SaidElsewhere> options) {
  for (const auto& [option, where] : options) {
    const CLI::Option* given = command.get_option_no_throw(std::string(option));
    if (given == nullptr || given->count() == 0) continue;
    throw UsageError({"job.argument.wrong", std::string(option) + " is not an argument of a job", "",
                      "remove it, because " + std::string(where)});
  }
}

/// Makes choices that depend on the names of outputs, because a job does not keep these names.
void complete(RenderSpec& spec) {
  work::complete_film(spec);
}
void complete(CastSpec& /*spec*/) {}

/// Returns the text of the specification that these arguments of the command describe.
template <typename Spec>
std::string read_words(const std::string& name, void (*add_options)(CLI::App&, Spec&),
                       const std::vector<std::string>& arguments, OutputWords outputs) {
  check_asks_for_work(arguments);
  CLI::App program("", "promin");
  Spec spec;
  CLI::App& command = add_command(program, name, "");
  add_spec_option(command, spec);
  add_options(command, spec);
  std::vector<const char*> words = {"promin", name.c_str()};
  for (const std::string& word : arguments) words.push_back(word.c_str());
  static_cast<void>(parse_arguments(program, static_cast<int>(words.size()), words.data()));
  if (outputs == OutputWords::kRefused) refuse_given(command, kOutputs);
  refuse_given(command, kSaidElsewhere);
  complete(spec);
  return write_spec(spec);
}

}  // namespace

std::string spec_of_words(const std::string& kind, const std::vector<std::string>& arguments, OutputWords outputs) {
  if (kind == kPictureJob) return read_words(kind, add_render_options, arguments, outputs);
  if (kind == kRayJob) return read_words(kind, add_cast_options, arguments, outputs);
  work::refuse_kind(kind);
}

}  // namespace promin::app
