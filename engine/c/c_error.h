// SPDX-License-Identifier: Apache-2.0
// Errors of the C interface (weft/c.h), and the border that no exception crosses.
#pragma once

#include <exception>
#include <new>
#include <string>

#include "weft/c.h"
#include "weft/error.h"

struct weft_error {
  weft::Error error;
  std::string status;  // as a message
};

namespace weft {

// Null if memory ran out.
weft_error* error_of(const Error& what);

// What `make`, which returns a Result<T*>, makes; or null, and its error unless `error` is null.
template <class T, class F>
T* made_by(F&& make, weft_error** error) {
  const auto tell = [&](const Error& what) -> T* {
    if (error != nullptr) *error = error_of(what);
    return nullptr;
  };
  try {
    const Result<T*> made = make();
    return made ? *made : tell(made.error());
  } catch (const std::bad_alloc&) {
    return tell({ErrorCode::kOutOfMemory, "", "memory ran out"});
  } catch (const std::exception& e) {
    return tell({ErrorCode::kInternal, "", e.what()});
  }
}

}  // namespace weft
