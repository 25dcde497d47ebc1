// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/stand_in.h"

#include <algorithm>
#include <cctype>

namespace promin {
namespace {

constexpr StandIn kPointer = {"a Git LFS pointer", "run \"git lfs pull\" in its repository"};
constexpr StandIn kPage = {"an HTML page", "download the file itself"};

bool starts_with_any_case(std::string_view text, std::string_view lower_case) {
  return text.size() >= lower_case.size() &&
         std::equal(lower_case.begin(), lower_case.end(), text.begin(),
                    [](char a, char b) { return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b))); });
}

}  // namespace

std::string_view skip_to_text(std::string_view bytes) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (bytes.starts_with(kByteOrderMark)) bytes.remove_prefix(kByteOrderMark.size());
  bytes.remove_prefix(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
  return bytes;
}

const StandIn* find_stand_in(std::string_view first_bytes) {
  const std::string_view text = skip_to_text(first_bytes);
  if (text.starts_with("version https://git-lfs")) return &kPointer;
  // Other kinds of XML begin with other names.
  if (starts_with_any_case(text, "<!doctype html") || starts_with_any_case(text, "<html")) return &kPage;
  return nullptr;
}

}  // namespace promin
