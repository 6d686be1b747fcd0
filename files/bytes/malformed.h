// SPDX-License-Identifier: Apache-2.0
// What readers of nested text throw within one source file, and catch there.
//
//   try { ... must(scanner.real("the x coordinate")) ... }
//   catch (const Malformed& malformed) { return tl::unexpected(malformed.error); }
#pragma once

#include <type_traits>
#include <utility>

#include "files/base/error.h"

namespace weft::files {

struct Malformed {
  Error error;
};

// The value. Throws Malformed if there is none.
template <class T>
T must(Result<T> result) {
  if (!result) throw Malformed{std::move(result.error())};
  if constexpr (!std::is_void_v<T>) return std::move(*result);
}

}  // namespace weft::files
