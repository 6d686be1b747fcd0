// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/cairo_library.h"

namespace weft::client {

Result<void> load_cairo() {
  const auto& loaded = loaded_functions<Cairo>(WEFT_CAIRO_SONAME);
  if (loaded) return {};
  return fail(ExitCode::kInternal, loaded.error() + "; weft draws with cairo");
}

const Cairo& loaded_cairo() {
  return *loaded_functions<Cairo>(WEFT_CAIRO_SONAME);
}

}  // namespace weft::client
