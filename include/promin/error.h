// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "promin/export.h"

namespace promin {

/// One thing that is wrong: `what` is, `where` it is (a file, a JSON path, a line), and the `cure`.
/// Written "WHAT, WHERE; what to do"; empty parts are left out.
struct PROMIN_EXPORT Problem {
  std::string what;
  std::string where;
  std::string cure;

  std::string sentence() const;
};

/// Base of every failure that is not a bug. Bugs assert; expected outcomes are returned; only main catches.
/// what() is the first problem's sentence, with the count where there are several, and the others after it,
/// each on an indented line of its own.
class PROMIN_EXPORT Error : public std::runtime_error {
 public:
  explicit Error(const Problem& problem) : Error(std::vector<Problem>{problem}) {}
  explicit Error(const std::vector<Problem>& problems);

  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// An argument or the command line is wrong (exit code 2).
struct PROMIN_EXPORT UsageError : Error {
  using Error::Error;
};

/// A scene, ray or BVH file, or a scene in memory, is bad (exit code 3).
struct PROMIN_EXPORT InputError : Error {
  using Error::Error;
};

/// There is no usable Vulkan device, or none that was asked for (exit code 4).
struct PROMIN_EXPORT DeviceError : Error {
  using Error::Error;
};

/// A ProgressCallback wanted an end; what was being done is undone.
struct PROMIN_EXPORT Cancelled : Error {
  Cancelled() : Error(Problem{"cancelled", "", ""}) {}
};

/// Failed while running: I/O, memory, a lost device (exit code 1).
struct PROMIN_EXPORT RunError : Error {
  using Error::Error;
};

}  // namespace promin
