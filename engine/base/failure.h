// SPDX-License-Identifier: Apache-2.0
// Carries an Error through code that cannot return one. Code of the engine that catches
// std::bad_alloc must catch this, too: it does not leave the engine.
#pragma once

#include <exception>
#include <utility>

#include "weft/error.h"

namespace weft {

class Failure : public std::exception {
 public:
  explicit Failure(Error error) : error_(std::move(error)) {}
  const Error& error() const noexcept { return error_; }
  const char* what() const noexcept override { return error_.message.c_str(); }

 private:
  Error error_;
};

}  // namespace weft
