// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/plugin/own_formats.h"

#include <algorithm>
#include <array>

namespace {

constexpr std::array<OwnFormat, 3> kFormats = {
    {{"avif", read_avif_size, read_avif}, {"ktx2", read_ktx2_size, read_ktx2}, {"webp", read_webp_size, read_webp}}};

}  // namespace

const OwnFormat* find_own_format(std::string_view name) {
  const auto* const format = std::ranges::find(kFormats, name, &OwnFormat::name);
  return format == kFormats.end() ? nullptr : format;
}
