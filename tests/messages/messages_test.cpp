// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// messages.txt contains the sentences of all problems. PROMIN_UPDATE_MESSAGES=1 makes this test write the file.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

#include "core/utf8.h"
#include "messages/message_cases.h"
#include "support/golden_messages.h"
#include "support/problems.h"
#include "support/temp_folder.h"

namespace promin {

namespace fs = std::filesystem;

void write_case(const std::string& name, std::string_view bytes) {
  fs::remove(name);
  std::ofstream(name, std::ios::binary) << bytes;
}

namespace {

const fs::path kGolden = fs::path(PROMIN_SOURCE_DIR) / "tests/messages/messages.txt";

/// Codes that no test of the host can provoke: they need a device, a window or a defect of the system.
const std::set<std::string> kNotProvoked = {
    // These need a device, and scenes on it.
    "device.buffer.large",
    "device.call.failed",
    "device.driver.manifest",
    "device.lists.differ",
    "device.loader.missing",
    "device.lost",
    "device.memory.file",
    "device.memory.short",
    "device.missing",
    "device.textures.large",
    "device.unknown",
    "device.unusable",
    "device.validation.missing",
    "device.validation.mode",
    "device.validation.reports",
    "device.vulkan.start",
    "argument.missing",
    "argument.range",
    "explain.rays.many",
    "rays.hits.many",
    "rays.query",
    "rays.results",
    "scene.copies.opaque",
    "scene.materials.count",
    "scene.move.copied",
    "scene.move.sheared",
    "scene.pose.other",
    "sheet.scenes.missing",
    "textures.halved",
    "view.crop.unsupported",
    "view.target.missing",
    // This one needs a window.
    "window.display",
    "window.scene.closed",
    "window.screenshots.many",
    // These need the system: limits, disks, libraries and files that change.
    "file.access",
    "file.keep",
    "file.open",
    "file.read",
    "file.room",
    "file.write",
    "folder.create",
    "hash.failed",
    "host.memory.short",
    "memory.space.short",
    "output.standard.closed",
    "plugin.damaged",
    "plugin.loading",
    "plugin.missing",
    "plugin.version",
    "program.failed",
    "sheet.name.drawn",
    "system.refused",
    // A test would take long to reach these sizes.
    "bvh.primitives.many",
    "bvh.tree.wrong",
    "scene.emitters.many",
    "scene.glasses.many",
    // These need pictures in formats that promin does not write.
    "picture.channels",
    "picture.encode",
    "picture.flat",
    "picture.rows",
    // These come from Python.
    "job.piece.unknown",
    "python.name.unknown",
    "python.value.wrong",
};

/// Literals that only have the form of a code.
const std::set<std::string> kNoCodes = {"asset.version"};

class MessagesTest : public TempFolder {
 protected:
  MessagesTest() { fs::current_path(folder_); }
  ~MessagesTest() override { fs::current_path(old_folder_); }

  /// Provokes the problem and returns the lines of its sentences.
  std::set<std::string> provoke(const MessageCase& message) const {
    for (const auto& entry : fs::directory_iterator(folder_)) fs::remove_all(entry);
    std::set<std::string> lines;
    try {
      message.provoke();
      ADD_FAILURE() << message.code << ": nothing was thrown";
    } catch (const Warned& warned) {
      EXPECT_FALSE(warned.warnings.empty()) << message.code;
      for (const std::string& warning : warned.warnings) {
        if (warning.find("; ") != std::string::npos) lines.insert(std::string(message.code) + " " + warning);
      }
    } catch (const Error& error) {
      EXPECT_TRUE(has_problem(list_problems(error), std::string(message.code)))
          << message.code << ", but it is " << list_problems(error);
      std::istringstream all(to_utf8(list_problems(error)));
      for (std::string line; std::getline(all, line);) {
        if (!line.starts_with(std::string(message.code) + " ")) continue;
        lines.insert(message.quotes_others ? std::regex_replace(line, std::regex("(\\(|: )[^:;]*;"), "$1...;") : line);
      }
    }
    return lines;
  }

 private:
  const fs::path old_folder_ = fs::current_path();
};

std::vector<MessageCase> all_cases() {
  std::vector<MessageCase> all;
  for (const auto& cases : {cases_of_files(), cases_of_gltf(), cases_of_values(), cases_of_usage(), cases_of_jobs()}) {
    all.insert(all.end(), cases.begin(), cases.end());
  }
  return all;
}

std::string read(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(MessagesTest, AreThoseOfTheGoldenFile) {
  std::set<std::string> lines;
  for (const MessageCase& message : all_cases()) lines.merge(provoke(message));
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  if (std::getenv("PROMIN_UPDATE_MESSAGES") != nullptr) std::ofstream(kGolden) << text;
  EXPECT_EQ(text, read(kGolden)) << "PROMIN_UPDATE_MESSAGES=1 writes " << kGolden;
}

bool is_code(std::string_view text) {
  const auto is_part = [](char c) { return c == '.' || (c >= 'a' && c <= 'z'); };
  return text.find('.', 1) != std::string_view::npos && text.front() != '.' && std::ranges::all_of(text, is_part);
}

/// Adds the codes of a source: literals that begin a list of arguments or members.
void find_codes(const std::string& source, std::set<std::string>& codes) {
  for (size_t begin = source.find('"'); begin != std::string::npos; begin = source.find('"', begin + 1)) {
    const size_t end = source.find('"', begin + 1);
    const size_t before = begin == 0 ? std::string::npos : source.find_last_not_of(" \n", begin - 1);
    if (end == std::string::npos || before == std::string::npos) continue;
    const std::string text = source.substr(begin + 1, end - begin - 1);
    const bool is_first = std::string_view("({=").find(source[before]) != std::string_view::npos;
    if (is_first && source.substr(end + 1, 1) == "," && is_code(text) && !kNoCodes.contains(text)) codes.insert(text);
  }
}

std::set<std::string> find_codes() {
  std::set<std::string> codes;
  for (const char* part : {"engine", "app", "python/native", "include"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(PROMIN_SOURCE_DIR) / part)) {
      const fs::path ending = entry.path().extension();
      if (ending == ".cpp" || ending == ".h") find_codes(read(entry.path()), codes);
    }
  }
  return codes;
}

TEST_F(MessagesTest, EachCodeHasASentence) {
  const GoldenMessages messages = read_golden_messages(kGolden);
  const std::set<std::string> codes = find_codes();
  EXPECT_GT(codes.size(), 200U);
  for (const std::string& code : codes) {
    EXPECT_NE(messages.contains(code), kNotProvoked.contains(code))
        << code << ": add a case, or name it as not provoked";
  }
  for (const std::string& code : kNotProvoked) EXPECT_TRUE(codes.contains(code)) << code << " occurs no longer";
  for (const auto& [code, sentence] : messages) EXPECT_TRUE(codes.contains(code)) << code << " occurs no longer";
}

/// Problems whose messages contain no advice.
const std::set<std::string> kWithoutCure = {"picture.pair.differs", "problems.more", "work.cancelled"};

TEST_F(MessagesTest, HaveTheForm) {
  for (const auto& [code, sentence] : read_golden_messages(kGolden)) {
    EXPECT_NE(sentence.find("; ") == std::string::npos, !kWithoutCure.contains(code)) << code << ": " << sentence;
    EXPECT_EQ(sentence.find("on the command line"), std::string::npos) << sentence;
  }
}

}  // namespace
}  // namespace promin
