// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "output/work_names.h"
#include "work/spec/render_spec.h"

namespace CLI {
class App;
}

// The options of `promin render`. They set a RenderSpec.
namespace promin::app {

class OptionTable;

/// Adds the rows of the view and the camera, which a window has too. `view` must outlive the parsing.
void add_view_options(OptionTable& table, ViewOptions& view);

/// Adds the rows of the environment. `options` must outlive the parsing.
void add_environment_options(OptionTable& table, EnvironmentOptions& options);

/// Adds the rows of --spp, whose help has this text after the defaults, and of --quality. `options` must outlive the
/// parsing.
void add_sample_options(OptionTable& table, RenderSpec& options, std::string_view more_defaults = "");

/// Adds the rows of --target-error, with this help, and of the options for its samples. `error` must outlive the
/// parsing.
void add_error_options(OptionTable& table, ErrorOptions& error, std::string_view target_help);

/// Adds the row of --fps, for commands that play a path. `fps` must outlive the parsing.
void add_fps_option(OptionTable& table, std::optional<double>& fps);

/// Adds a row for each option to the command. `options` must outlive the parsing.
void add_render_options(CLI::App& command, RenderSpec& options);

}  // namespace promin::app
