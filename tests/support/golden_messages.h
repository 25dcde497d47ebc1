// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace promin {

/// The sentences of tests/messages/messages.txt, indexed by the codes of their problems.
using GoldenMessages = std::multimap<std::string, std::string, std::less<>>;

inline GoldenMessages read_golden_messages(const std::string& file) {
  GoldenMessages messages;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const size_t space = line.find(' ');
    if (space != std::string::npos) messages.emplace(line.substr(0, space), line.substr(space + 1));
  }
  return messages;
}

/// Returns the words of a sentence that do not depend on its values: those of lower-case letters, except places (which
/// end in a colon), quoted words and suggestions.
inline std::vector<std::string> shape_of(std::string_view sentence) {
  std::string text(sentence);
  for (size_t begin = text.find('"'); begin != std::string::npos; begin = text.find('"', begin)) {
    text.erase(begin, text.find('"', begin + 1) - begin + 1);
  }
  std::vector<std::string> shape;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    while (!word.empty() && std::string_view(",;.?)").find(word.back()) != std::string_view::npos) word.pop_back();
    if (!word.empty() && word.front() == '(') word.erase(0, 1);
    const auto is_letter = [](unsigned char c) { return std::islower(c) != 0; };
    if (!word.empty() && std::ranges::all_of(word, is_letter)) shape.push_back(word);
  }
  return shape;
}

/// Returns whether a sentence has the words of a golden sentence with this code.
inline bool has_golden_words(const GoldenMessages& messages, std::string_view code, std::string_view sentence) {
  const auto [begin, end] = messages.equal_range(code);
  return std::any_of(begin, end, [&](const auto& message) { return shape_of(message.second) == shape_of(sentence); });
}

}  // namespace promin
