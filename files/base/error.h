// SPDX-License-Identifier: Apache-2.0
// The client's errors: the exit code to end with, and a sentence for the user that names the
// offender (file:line:column, option, address). No exception leaves a function that returns a
// Result.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

#include "files/base/exit_codes.h"

namespace weft::files {

struct Error {
  ExitCode exit = ExitCode::kInternal;
  std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(ExitCode exit, std::string message) {
  return tl::unexpected<Error>(Error{exit, std::move(message)});
}

}  // namespace weft::files
