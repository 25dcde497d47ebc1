// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/error.h"

namespace promin::work {

/// Receives the sentences that work reports beside its results. This class ignores them, as Python does; a program
/// prints them.
class Messages {
 public:
  virtual ~Messages() = default;

  /// A note about an assumption that neither the scene nor the user has specified.
  virtual void note(const std::string& /*text*/) const {}
  virtual void warn(const std::string& /*text*/) const {}
  virtual void warn(const Problem& /*problem*/) const {}
  /// A line about a step, for users who want to see each.
  virtual void detail(const std::string& /*text*/) const {}
};

}  // namespace promin::work
