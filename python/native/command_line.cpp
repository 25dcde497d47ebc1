// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "command_line.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <regex>
#include <utility>
#include <vector>

#include "bind.h"
#include "options/arguments.h"
#include "options/job_words.h"
#include "options/render_options.h"
#include "options/spec_options.h"
#include "options/typed_words.h"
#include "promin/error.h"
#include "promin/framing.h"
#include "promin/lighting.h"
#include "promin/setup_stats.h"
#include "records.h"
#include "work/pictures/picture_run.h"
#include "work/pictures/view_setup.h"
#include "work/spec/spec_json.h"
#include "work/spec/value_words.h"

namespace nb = nanobind;

namespace promin::python {
namespace {

nb::list write_names(Names names) {
  nb::list all;
  for (const std::string_view name : names) all.append(std::string(name));
  return all;
}

/// Returns the words that arguments accept, with the arguments' names in Python as keys.
nb::dict list_choices() {
  nb::dict choices;
  choices["alpha_mode"] = write_names(names_of(AlphaMode()));
  choices["attenuation"] = write_names(names_of(Attenuation()));
  choices["builder"] = write_names(builder_names());
  choices["compression"] = write_names(names_of(ExrCompression()));
  choices["integrator"] = write_names(names_of(Integrator()));
  choices["debug_view"] = write_names(names_of(DebugView()));
  choices["depth"] = write_names(names_of(DepthKind()));
  choices["error_in"] = write_names(work::error_space_names());
  choices["filter"] = write_names(names_of(PixelFilter()));
  choices["framing"] = write_names(framing_names());
  choices["instances"] = write_names(instancing_names());
  choices["kind"] = write_names(names_of(LightKind()));
  choices["light"] = write_names(light_choice_names());
  choices["projection"] = write_names(names_of(Projection()));
  choices["tone_mapping"] = write_names(names_of(ToneMapping()));
  return choices;
}

template <typename Model>
nb::dict write_default_material() {
  Material material;
  material.model = Model();
  return write(material);
}

template <typename Sky>
nb::object write_default_sky() {
  Environment environment;
  environment.sky = Sky();
  return write(environment)["sky"];
}

/// Returns the default values of the library's structs, and the defaults of the command line.
nb::dict list_defaults() {
  nb::dict defaults;
  Environment before_backdrop;
  before_backdrop.backdrop.emplace();
  defaults["Backdrop"] = write(before_backdrop)["backdrop"];
  defaults["Camera"] = write(Camera());
  defaults["Display"] = write(DisplayTransform());
  defaults["Environment"] = write(Environment());
  defaults["GradientSky"] = write_default_sky<GradientSky>();
  defaults["Light"] = write(Light());
  defaults["MetallicRoughness"] = write_default_material<MetallicRoughness>();
  defaults["Phong"] = write_default_material<Phong>();
  defaults["Studio"] = write_default_sky<Studio>();
  defaults["Unlit"] = write_default_material<Unlit>();
  defaults["ErrorTarget"] = write(ErrorTarget());
  defaults["ExrOptions"] = write(ExrOptions());
  defaults["View"] = write(View());
  const auto samples_of = [](Integrator integrator) {
    return work::samples_of(work::Quality::kNormal, {.integrator = integrator});
  };
  defaults["samples"] = samples_of(Integrator::kWhitted);
  defaults["noisy_samples"] = samples_of(Integrator::kDirect);
  defaults["builder"] = RendererOptions().builder;
  defaults["texture_memory"] = RendererOptions().texture_bytes;
  defaults["aspect_ratio"] = work::kDefaultAspectRatio;
  defaults["height"] = work::default_size(Camera())->y;
  defaults["coarse_min_spp"] = kMinRefinedSamples;
  defaults["max_depth_of_glass"] = kMaxDepthOfGlass;
  return defaults;
}

/// Returns the names of the options and arguments of `promin render`, as they appear in messages.
std::vector<std::string> list_options() {
  CLI::App command("", "render");
  work::RenderSpec options;
  bool prints_spec = false;
  app::add_spec_option(command, options);
  app::add_render_options(command, options);
  app::add_print_spec_option(command, prints_spec);
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    const std::vector<std::string>& words = option->get_lnames();
    names.push_back(words.empty() ? option->get_name(true) : "--" + words.front());
  }
  return names;
}

using Size = std::pair<uint32_t, uint32_t>;

/// Returns width and height of a camera's pictures if these sides are requested; a side of 0 is open. Returns None if
/// no size fits.
std::optional<Size> choose_size(const nb::dict& camera, const Size& sides) {
  const std::optional<uvec2> size = work::size_for({sides.first, sides.second}, read_camera(camera));
  if (!size) return {};
  return Size(size->x, size->y);
}

/// Reads one value in words. Throws UsageError, which names the keyword.
template <typename Read>
auto read_word(std::string_view keyword, const Read& read) {
  try {
    return read();
  } catch (const work::WrongValue& wrong) {
    throw UsageError({"spec.member.value", fmt::format("{} {}", keyword, wrong.what), "",
                      wrong.near.empty() ? "" : fmt::format("did you mean {}?", wrong.near)});
  }
}

/// Returns the sides that a size in words requests; a side of 0 is open.
Size read_size(const std::string& word) {
  const uvec2 size = read_word("size", [&] { return work::read_size(word); });
  return {size.x, size.y};
}

double read_time_limit(const std::string& word) {
  return read_word("time_limit", [&] { return work::read_seconds(word); });
}

/// Returns the fields of a view that the quality of a specification stands for.
nb::dict read_quality(const std::string& spec) {
  work::RenderSpec options = read_spec(spec);
  work::apply_quality(options);
  nb::dict fields;
  fields["spp"] = options.view.samples_per_pixel;
  fields["target_error"] = options.error.target;
  fields["error_in"] = std::string(
      work::error_space_names()[static_cast<size_t>(options.error.space.value_or(work::ErrorSpace::kLinear))]);
  return fields;
}

std::string spec_of_words(const std::string& kind, const std::vector<std::string>& arguments, bool names_outputs) {
  return app::spec_of_words(kind, arguments, names_outputs ? app::OutputWords::kAllowed : app::OutputWords::kRefused);
}

/// Returns the option, without dashes, that corresponds to another program's option of this name; empty if none is
/// known.
std::string find_option(const std::string& name) {
  CLI::App command("", "promin");
  work::RenderSpec options;
  app::add_render_options(command, options);
  const std::string typed = "--" + name;
  const std::string same = app::spell_out(command, {"promin", typed}).back();
  const std::string option = same == typed ? app::find_by_meaning(command, typed) : same;
  return option.empty() ? option : option.substr(2);
}

/// Returns the ErrorTarget of a view, as the command line derives it from its options; None if pixels have a fixed
/// number of samples. `asked` has the fields target_error, time_limit, min_spp, max_spp and error_in; `display` is the
/// display transform.
nb::object error_target(const nb::dict& asked, const nb::dict& display) {
  work::ErrorOptions options;
  options.target = read_real(asked, "target_error");
  options.time_limit_s = read_real(asked, "time_limit");
  options.min_samples = read_whole(asked, "min_spp");
  options.max_samples = read_whole(asked, "max_spp");
  const auto space = nb::cast<std::string>(asked["error_in"]);
  options.space = static_cast<work::ErrorSpace>(find_name(work::error_space_names(), space, "error_in"));
  std::optional<ErrorTarget> target = options.error_target();
  if (!target) return nb::none();
  work::fit_to_display(*target, read_display(display));
  return write(*target);
}

}  // namespace

std::string name_keywords(const std::string& sentence) {
  static const std::regex option("--([a-z]+(-[a-z]+)*)");
  std::string named;
  size_t end = 0;
  for (std::sregex_iterator found(sentence.begin(), sentence.end(), option), none; found != none; ++found) {
    std::string name = (*found)[1];
    std::ranges::replace(name, '-', '_');
    named += sentence.substr(end, static_cast<size_t>(found->position()) - end) + name;
    if (name == "from") named += '_';  // a keyword of Python
    end = static_cast<size_t>(found->position() + found->length());
  }
  return named + sentence.substr(end);
}

UsageError name_keywords(const UsageError& error) {
  const Problem& problem = error.problems().front();
  return UsageError({problem.code, name_keywords(problem.what), "", name_keywords(problem.cure)});
}

work::RenderSpec read_spec(const std::string& text) {
  try {
    return work::parse_spec<work::RenderSpec>(text, {});
  } catch (const InputError& error) {
    Problem problem = error.problems().front();
    // A keyword of Python's language has an underscore at its end.
    const bool is_from = problem.what.starts_with("from ");
    const std::string what = is_from ? fmt::format("from_{}", problem.what.substr(4)) : problem.what;
    throw UsageError({problem.code, what, "", name_keywords(problem.cure)});
  }
}

Metadata describe_picture(const View& view, const DisplayTransform& display, const std::optional<PictureError>& error,
                          const gpu::DeviceInfo& device, const std::string& scene_file, const Scene& named,
                          const AovSet& aovs) {
  work::RunStats stats;
  stats.device = device;
  stats.scene_file = scene_file;
  stats.view = view;
  stats.display = display;
  if (error) stats.errors.push_back(*error);
  return work::make_metadata(stats, {}, work::describe_aovs(named, aovs, false, view.depth_kind));
}

void bind_command_line(nb::module_& module) {
  module.def("list_choices", &list_choices);
  module.def("list_defaults", &list_defaults);
  module.def("list_options", &list_options);
  module.def("choose_size", &choose_size, nb::arg("camera"), nb::arg("sides"));
  module.def("read_size", &read_size);
  module.def("read_time_limit", &read_time_limit);
  module.def("read_quality", &read_quality, nb::arg("spec"));
  module.def("spec_of_words", &spec_of_words, nb::arg("kind"), nb::arg("arguments"), nb::arg("names_outputs"));
  module.def("find_option", &find_option);
  module.def("error_target", &error_target, nb::arg("asked"), nb::arg("display"));
}

}  // namespace promin::python
