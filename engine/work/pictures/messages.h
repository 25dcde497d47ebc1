// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/error.h"

namespace promin::work {

/// Receives the notes and warnings of a task. This class ignores them, as the Python module does. The programs derive a
/// class that prints them.
class Messages {
 public:
  virtual ~Messages() = default;

  /// Receives a note about an assumption that neither the scene nor the user has made explicit.
  virtual void note(const std::string& /*text*/) const {}
  virtual void warn(const std::string& /*text*/) const {}
  virtual void warn(const Problem& /*problem*/) const {}
  /// Receives a line about a step, for users who want to see every step.
  virtual void detail(const std::string& /*text*/) const {}
};

}  // namespace promin::work
