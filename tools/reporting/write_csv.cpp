// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/write_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/file.h"

namespace promin::report {
namespace {

using Fields = std::vector<std::pair<std::string, std::string>>;

/// A column of its own has no room for all values: they go to runs.csv.
constexpr const char* kValues = "values";

/// RFC 4180.
std::string quote(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

/// An object's values; of objects in it as "ns_per_test.median".
void flatten(const Json& object, const std::string& prefix, Fields& fields) {
  for (const auto& [key, value] : object.items()) {
    if (key == kValues) continue;
    if (value.is_object()) {
      flatten(value, prefix + key + ".", fields);
    } else {
      fields.emplace_back(prefix + key, value.is_string() ? value.get<std::string>() : value.dump());
    }
  }
}

std::string write_table(const Json& rows, const Json& provenance) {
  std::vector<std::string> columns;
  std::vector<Fields> lines;
  for (const Json& row : rows) {
    Fields& fields = lines.emplace_back();
    flatten(row, "", fields);
    for (const char* key : {"device", "driver", "compiler", "commit", "date"}) {
      fields.emplace_back(key, provenance.at(key).get<std::string>());
    }
    for (const auto& [name, value] : fields) {
      if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
    }
  }
  std::string text;
  const auto add_line = [&](const auto& value_of) {
    for (size_t i = 0; i < columns.size(); ++i) {
      if (i > 0) text += ',';
      text += quote(value_of(columns[i]));
    }
    text += "\r\n";
  };
  add_line([](const std::string& column) { return column; });
  for (const Fields& fields : lines) {
    const std::map<std::string, std::string> by_name(fields.begin(), fields.end());
    add_line([&](const std::string& column) {
      const auto found = by_name.find(column);
      return found == by_name.end() ? std::string() : found->second;
    });
  }
  return text;
}

/// A line for each value of each time in these rows.
void add_runs(const std::string& table, const Json& rows, std::string& text) {
  for (const Json& row : rows) {
    for (const auto& [figure, times] : row.items()) {
      if (!times.is_object() || !times.contains(kValues)) continue;
      size_t run = 0;
      for (const Json& value : times[kValues]) {
        text += fmt::format("{},{},{},{},{:.7g}\r\n", table, quote(row.at("id").get<std::string>()), figure, ++run,
                            value.get<double>());
      }
    }
  }
}

}  // namespace

void write_csv_files(const Json& report, const std::filesystem::path& folder) {
  std::string runs = "table,id,figure,run,value\r\n";
  for (const auto& [section, content] : report.items()) {
    if (!content.is_object()) continue;
    for (const auto& [key, table] : content.items()) {
      if (!table.is_array() || table.empty() || !table.front().is_object()) continue;
      const std::string name = key == "rows" ? section : section + "_" + key;
      write_text_file(folder / (name + ".csv"), write_table(table, report.at("provenance")));
      add_runs(name, table, runs);
    }
  }
  write_text_file(folder / "runs.csv", runs);
}

void drop_values(Json& json) {
  if (json.is_object()) json.erase(kValues);
  for (Json& part : json) {
    if (part.is_structured()) drop_values(part);
  }
}

}  // namespace promin::report
