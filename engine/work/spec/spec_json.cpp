// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/spec/spec_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/file.h"
#include "core/json_text.h"
#include "core/suggest.h"
#include "core/utf8.h"
#include "formats/gltf/parse_json.h"
#include "promin/error.h"
#include "work/spec/spec_fields.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The version of the format.
constexpr int kFormat = 1;

/// Returns the key of the format's version.
const char* key_of(const RenderSpec* /*kind*/) {
  return "promin_render_spec";
}
const char* key_of(const CastSpec* /*kind*/) {
  return "promin_cast_spec";
}

template <typename Spec>
const fields::Field<Spec>* find_field(std::string_view name) {
  const auto& fields = fields::fields_of<Spec>();
  const auto found = std::ranges::find(fields, name, &fields::Field<Spec>::name);
  return found == fields.end() ? nullptr : &*found;
}

/// Changes each text in a value that is the name of a file.
void change_paths(Json& value, const std::function<std::string(const std::string&)>& change) {
  if (value.is_string() && value.get<std::string>() != kStandardInput) value = change(value.get<std::string>());
  if (!value.is_array()) return;
  for (Json& part : value) change_paths(part, change);
}

std::string make_absolute(const std::string& path) {
  if (to_utf8(path) != path) {
    throw UsageError({"spec.file.name", "the name of the file is not UTF-8, so a specification cannot contain it", path,
                      "rename the file"});
  }
  return fs::absolute(path).lexically_normal().string();
}

template <typename Spec>
std::string write_fields(const Spec& spec, bool is_of_pieces) {
  Json json = {{key_of(&spec), kFormat}};
  for (const fields::Field<Spec>& field : fields::fields_of<Spec>()) {
    if (is_of_pieces && !field.traits.is_of_pieces) continue;
    Json value = field.write(spec);
    if (value.is_null() || value == field.traits.usual) continue;
    if (field.traits.is_file) change_paths(value, make_absolute);
    json[field.name] = std::move(value);
  }
  // Arrays of a few numbers are written on one line.
  std::vector<std::string> lines;
  for (const auto& [name, value] : json.items()) lines.push_back(fmt::format(" \"{}\": {}", name, json_text(value)));
  return fmt::format("{{\n{}\n}}\n", fmt::join(lines, ",\n"));
}

template <typename Spec>
void read_member(const std::string& name, const nlohmann::json& parsed, const fs::path& folder, Spec& spec,
                 LoadReport& report) {
  const fields::Field<Spec>* field = find_field<Spec>(name);
  if (field == nullptr) {
    std::vector<std::string_view> known;
    for (const fields::Field<Spec>& each : fields::fields_of<Spec>()) known.push_back(each.name);
    const std::string_view near = nearest_name(name, known);
    report.refuse("spec.member.unknown", fmt::format("a specification has no member {}", quote(name)), "",
                  near.empty() ? "remove it" : fmt::format("did you mean {}?", near));
    return;
  }
  Json value = parsed;
  if (field->traits.is_file) change_paths(value, [&](const std::string& path) { return (folder / path).string(); });
  try {
    field->read(value, spec);
  } catch (const WrongValue& wrong) {
    report.refuse("spec.member.value", fmt::format("{} {}", name, wrong.what), "",
                  wrong.near.empty() ? "correct it or remove it" : fmt::format("did you mean {}?", wrong.near));
  }
}

/// Returns a value as it is written on a command line.
std::string describe_value(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value == true) return "given";
  if (!value.is_array()) return json_text(value);
  std::vector<std::string> parts;
  for (const Json& part : value) parts.push_back(describe_value(part));
  return fmt::format("{}", fmt::join(parts, " "));
}

}  // namespace

std::string option_of(std::string member) {
  std::ranges::replace(member, '_', '-');
  return "--" + member;
}

template <typename Spec>
Spec parse_spec(std::string_view text, const fs::path& file) {
  const std::string key = key_of(static_cast<const Spec*>(nullptr));
  LoadReport report(file);
  const std::string cure =
      fmt::format("give a file that promin's --print-spec has written, with \"{}\": {}", key, kFormat);
  const nlohmann::json json = parse_json(text, report, cure);
  if (!json.is_object() || !json.contains(key) || json[key] != kFormat) {
    report.refuse("spec.format", fmt::format("the file has no member \"{}\" with the value {}", key, kFormat), "",
                  cure);
    report.throw_if_refused();
  }
  const fs::path folder = file == kStandardInput ? fs::path() : file.parent_path();
  Spec spec;
  for (const auto& [name, value] : json.items()) {
    if (name != key) read_member(name, value, folder, spec, report);
  }
  report.throw_if_refused();
  return spec;
}

template <typename Spec>
Spec read_spec(const fs::path& file) {
  if (file == kStandardInput) {
    return parse_spec<Spec>(std::string(std::istreambuf_iterator<char>(std::cin), {}), file);
  }
  const std::vector<std::byte> bytes = read_file(file);
  return parse_spec<Spec>({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
}

template <typename Spec>
std::string write_spec(const Spec& spec) {
  return write_fields(spec, false);
}

template <typename Spec>
std::string write_spec_of_pieces(const Spec& spec) {
  return write_fields(spec, true);
}

template <typename Spec>
std::vector<std::pair<std::string, std::string>> list_bits(const Spec& spec) {
  std::vector<std::pair<std::string, std::string>> bits;
  for (const fields::Field<Spec>& field : fields::fields_of<Spec>()) {
    if (!field.traits.affects_bits) continue;
    Json value = field.write(spec);
    if (value.is_null() || value == field.traits.usual) continue;
    if (field.traits.is_file) {
      change_paths(value, [](const std::string& path) { return fs::path(path).filename().string(); });
    }
    bits.emplace_back(option_of(field.name), describe_value(value));
  }
  return bits;
}

template <typename Spec>
void clear_rivals(Spec& spec, std::string_view option) {
  const auto& fields = fields::fields_of<Spec>();
  const auto found =
      std::ranges::find_if(fields, [&](const fields::Field<Spec>& field) { return option_of(field.name) == option; });
  if (found == fields.end()) return;
  for (const std::string_view rival : found->traits.replaces) {
    const fields::Field<Spec>* field = find_field<Spec>(rival);
    if (field != nullptr) field->reset(spec);
  }
}

#define PROMIN_SPEC_FUNCTIONS(SPEC)                                                      \
  template SPEC read_spec<SPEC>(const fs::path& file);                                   \
  template SPEC parse_spec<SPEC>(std::string_view text, const fs::path& file);           \
  template std::string write_spec(const SPEC& spec);                                     \
  template std::string write_spec_of_pieces(const SPEC& spec);                           \
  template std::vector<std::pair<std::string, std::string>> list_bits(const SPEC& spec); \
  template void clear_rivals(SPEC& spec, std::string_view option);
PROMIN_SPEC_FUNCTIONS(RenderSpec)
PROMIN_SPEC_FUNCTIONS(CastSpec)
#undef PROMIN_SPEC_FUNCTIONS

}  // namespace promin::work
