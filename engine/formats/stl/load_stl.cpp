// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/stl/load_stl.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "core/file.h"
#include "formats/stl/text.h"
#include "formats/text_lines.h"
#include "promin/validate.h"

namespace promin {
namespace {

static_assert(std::endian::native == std::endian::little, "the numbers of the file are little-endian");

// A binary file: a header that may say anything, the count of facets, and for each of these the normal, three corners
// and two bytes.
constexpr size_t kHeaderBytes = 80;
constexpr size_t kFirstFacet = kHeaderBytes + 4;
constexpr size_t kFacetBytes = 50;
constexpr size_t kNormalBytes = 12;
constexpr size_t kCornersBytes = 36;

uint64_t facet_count(std::string_view file) {
  uint32_t count = 0;
  std::memcpy(&count, file.data() + kHeaderBytes, sizeof(count));
  return count;
}

/// Texts begin with "solid", but so do the headers of some binary files. Those hold zeros further on, in their count at
/// the latest unless it is beyond 16 million.
bool is_text(std::string_view file) {
  if (file.size() >= kFirstFacet && file.size() == kFirstFacet + kFacetBytes * facet_count(file)) return false;
  std::string_view begin = file.substr(0, kFirstFacet + kFacetBytes);
  if (begin.find('\0') != std::string_view::npos) return false;
  begin = without_byte_order_mark(begin);
  begin.remove_prefix(std::min(begin.find_first_not_of(" \t\r\n"), begin.size()));
  return is_stl_keyword(begin.substr(0, 5), "solid");
}

/// nullopt where a coordinate is out of range.
std::optional<StlSolid> read_facets(std::string_view file, uint64_t count, LoadReport& report) {
  report.note_rounded_coordinates();
  StlSolid solid;
  solid.corners.resize(3 * count);
  bool has_attributes = false;
  for (uint64_t i = 0; i < count; ++i) {
    const char* facet = file.data() + kFirstFacet + kFacetBytes * i;
    float coordinates[9];
    uint16_t attribute = 0;
    std::memcpy(coordinates, facet + kNormalBytes, kCornersBytes);
    std::memcpy(&attribute, facet + kNormalBytes + kCornersBytes, sizeof(attribute));
    has_attributes = has_attributes || attribute != 0;
    for (const float coordinate : coordinates) {
      // Written so that NaN fails.
      if (std::abs(coordinate) <= kMaxCoordinate) continue;
      report.refuse("a vertex coordinate is not finite or beyond 1e15", "facet " + std::to_string(i),
                    "export the mesh again, in a larger unit of length");
      return std::nullopt;
    }
    for (uint64_t corner = 0; corner < 3; ++corner) {
      const float* p = &coordinates[3 * corner];
      solid.corners[3 * i + corner] = dvec3(p[0], p[1], p[2]) - report.center();
    }
  }
  if (has_attributes) report.warn("colours of binary STL are ignored");
  return solid;
}

std::vector<StlSolid> read_binary(std::string_view file, LoadReport& report) {
  if (file.size() < kFirstFacet) {
    report.refuse("the file is no STL", "", "name an STL file, binary or text");
    return {};
  }
  const uint64_t count = facet_count(file);
  const uint64_t room = (file.size() - kFirstFacet) / kFacetBytes;
  if (count > room) {
    report.refuse("the file tells of " + std::to_string(count) + " facets and has room for " + std::to_string(room), "",
                  "the file is cut short, or no STL: copy or export it again");
    return {};
  }
  if (file.size() > kFirstFacet + kFacetBytes * count) report.warn("bytes behind the last facet are ignored");
  std::optional<StlSolid> solid = read_facets(file, count, report);
  return solid ? std::vector<StlSolid>{std::move(*solid)} : std::vector<StlSolid>{};
}

Mesh make_mesh(StlSolid& solid) {
  Mesh mesh;
  mesh.positions = std::move(solid.corners);
  const auto count = static_cast<uint32_t>(mesh.positions.size() / 3);
  mesh.triangles.reserve(count);
  for (uint32_t i = 0; i < count; ++i) mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  return mesh;
}

}  // namespace

Scene load_stl(const LoadOptions& /*options*/, LoadReport& report) {
  const std::vector<std::byte> bytes = read_file(report.file());
  const std::string_view file(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::vector<StlSolid> solids = is_text(file) ? parse_stl_text(file, report) : read_binary(file, report);
  report.throw_if_refused();

  Scene scene;
  scene.file = report.file();
  scene.materials.emplace_back();
  scene.materials.back().name = "default";
  for (StlSolid& solid : solids) {
    if (!solid.corners.empty()) scene.add(solid.name, make_mesh(solid));
  }
  scene.warnings = report.warnings();
  return scene;
}

}  // namespace promin
