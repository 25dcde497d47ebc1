// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/load_report.h"

#include <algorithm>

#include "core/utf8.h"

namespace promin {
namespace {

/// The largest number of problems to print. A faulty exporter may repeat a fault for every vertex.
constexpr size_t kMaxProblems = 50;
constexpr size_t kMaxWord = 80;

std::string make_visible(const std::string& words) {
  return to_one_line(to_utf8(words));
}

}  // namespace

std::string quote(std::string_view word) {
  std::string quoted(1, '"');
  quoted.append(word.substr(0, kMaxWord)).append(word.size() > kMaxWord ? "...\"" : "\"");
  return quoted;
}

void LoadReport::refuse(ProblemCode code, const std::string& what, const std::string& place, const std::string& cure) {
  const Problem problem{code, make_visible(what), file_.string() + (place.empty() ? "" : ": " + make_visible(place)),
                        make_visible(cure)};
  if (problems_.size() < kMaxProblems && !said_.insert(problem.sentence()).second) return;
  ++problem_count_;
  if (problems_.size() < kMaxProblems) problems_.push_back(problem);
}

void LoadReport::warn(const std::string& sentence) {
  if (said_.insert(sentence).second) warnings_.push_back({make_visible(sentence), "", 0});
}

void LoadReport::refuse(const Fault& fault) {
  if (!refused_fault_) refused_fault_ = fault;
  refuse(fault.code, fault.what + (fault.value.empty() ? "" : " (" + fault.value + ")"), fault.place, fault.cure);
}

void LoadReport::repair(const Fault& fault) {
  if (!is_strict_) return warn(fault);
  refuse(fault);
}

void LoadReport::warn(const Fault& fault) {
  const std::string value = fault.value.empty() ? "" : " (" + fault.value + ")";
  const auto [kind, is_new] = kinds_.try_emplace({fault.what, fault.repair}, warnings_.size());
  if (is_new) {
    const std::string place = fault.place.empty() ? "" : fault.place + ": ";
    warnings_.push_back({make_visible(place + fault.what + value), fault.repair, 0});
  }
  ++warnings_[kind->second].fault_count;
}

std::vector<std::string> LoadReport::warnings() const {
  std::vector<std::string> sentences;
  for (const Warning& warning : warnings_) {
    std::string sentence = warning.sentence;
    if (warning.fault_count > 1) sentence += ", and " + std::to_string(warning.fault_count - 1) + " more";
    if (!warning.repair.empty()) sentence += "; " + warning.repair;
    sentences.push_back(std::move(sentence));
  }
  return sentences;
}

void LoadReport::add_source(const std::filesystem::path& file) {
  const auto is_same = [&](const SourceFile& source) { return source.file == file; };
  if (std::none_of(sources_.begin(), sources_.end(), is_same)) sources_.push_back({file, stamp_of(file)});
}

void LoadReport::throw_if_refused() const {
  if (problems_.empty()) return;
  std::vector<Problem> problems = problems_;
  if (problem_count_ > problems.size()) {
    problems.push_back({"problems.more", "and " + std::to_string(problem_count_ - problems.size()) + " more", "", ""});
  }
  throw InputError(problems);
}

}  // namespace promin
