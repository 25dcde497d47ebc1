// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check the manual pages and completions that are installed.
#include <gmock/gmock.h>

#include <regex>

#include "app/cli_fixture.h"

namespace promin {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::pair<const char*, std::vector<const char*>> kPrograms[] = {
    {"promin", {"render", "cast", "compare", "info", "devices"}},
    {"promin-bvh", {"build", "info", "verify"}},
    {"promin-view", {}}};

class ManualCliTest : public CliTest {
 protected:
  ProcessResult run_program(const std::string& program, const OptionValues& arguments) const {
    return Process(std::filesystem::path(PROMIN_EXECUTABLE).parent_path() / program, arguments, options_).wait();
  }
  std::string make(const std::string& program, const std::string& kind) const {
    const ProcessResult result = run_program(program, {"--make-manual", kind});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  }
  /// Returns all options that --help of the program and its commands names.
  std::set<std::string> options_of(const std::string& program, const std::vector<const char*>& commands) const {
    std::string help = run_program(program, {"--help"}).out;
    for (const char* command : commands) help += run_program(program, {command, "--help"}).out;
    std::set<std::string> options;
    const std::regex option("\n  (?:-\\w,)?--([a-z-]+)");
    for (std::sregex_iterator each(help.begin(), help.end(), option), end; each != end; ++each) {
      options.insert((*each)[1]);
    }
    return options;
  }
  /// Returns the completions that bash offers for a command line whose last word is incomplete.
  std::string complete(const std::string& program, const std::string& function, const std::string& line) const {
    write("completion", make(program, "bash"));
    const std::string script = "source ./completion; COMP_WORDS=(" + line +
                               "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); " + function +
                               "; printf '%s ' \"${COMPREPLY[@]}\"";
    const ProcessResult result = Process("/bin/bash", {"-c", script}, options_).wait();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return result.out;
  }
};

TEST_F(ManualCliTest, EveryOptionIsInEachOfThem) {
  for (const auto& [program, commands] : kPrograms) {
    const std::set<std::string> options = options_of(program, commands);
    EXPECT_GE(options.size(), 5U);
    const std::string man = std::regex_replace(make(program, "man"), std::regex("\\\\-"), "-");
    const std::string zsh = make(program, "zsh");
    const std::string fish = make(program, "fish");
    const std::string bash = make(program, "bash");
    for (const std::string& option : options) {
      EXPECT_THAT(man, HasSubstr("--" + option)) << program;
      EXPECT_THAT(bash, HasSubstr("--" + option)) << program;
      EXPECT_THAT(zsh, HasSubstr("'*--" + option + "[")) << program;
      EXPECT_THAT(fish, HasSubstr(" -l " + option + " ")) << program;
    }
    for (const char* command : commands) EXPECT_THAT(man, HasSubstr(std::string(".SS ") + command + "\n"));
    EXPECT_THAT(zsh, StartsWith(std::string("#compdef ") + program + "\n"));
  }
}

// roff reads a line that begins with a full stop or a quote as a request, so the line would be lost or cause an error.
TEST_F(ManualCliTest, ThePagesHaveOnlyRequestsThatThereAre) {
  const std::set<std::string> requests = {".TH", ".SH", ".SS", ".TP", ".B", ".I", ".BR", ".br", ".\\\""};
  for (const auto& [program, commands] : kPrograms) {
    std::istringstream page(make(program, "man"));
    for (std::string line; std::getline(page, line);) {
      EXPECT_FALSE(line.starts_with("'")) << line;
      const bool is_request = line.starts_with(".");
      EXPECT_TRUE(!is_request || requests.contains(line.substr(0, line.find(' ')))) << line;
    }
  }
}

TEST_F(ManualCliTest, BashOffersCommandsOptionsAndWords) {
  EXPECT_EQ(complete("promin", "_promin", "promin re"), "render ");
  EXPECT_EQ(complete("promin", "_promin", "promin render --tone-mapping a"), "aces agx ");
  EXPECT_EQ(complete("promin", "_promin", "promin render --exposure ''"), "auto average ");
  EXPECT_EQ(complete("promin", "_promin", "promin cast --any"), "--any ");
  EXPECT_EQ(complete("promin", "_promin", "promin cast --tone"), " ") << "of another command";
  EXPECT_EQ(complete("promin", "_promin", "promin render squ"), "square.gltf ");
  EXPECT_EQ(complete("promin-view", "_promin_view", "promin-view --light h"), "headlight ");
  EXPECT_EQ(complete("promin-view", "_promin_view", "promin-view tri"), "triangle.obj ");
}

TEST_F(ManualCliTest, AnotherKindIsRefused) {
  expect_failure(run({"--make-manual", "html"}), 2, "--make-manual takes man, bash, zsh or fish, not \"html\"");
}

}  // namespace
}  // namespace promin
