// SPDX-License-Identifier: Apache-2.0
#include "files/geo/proj_library.h"

namespace weft::files {

Result<void> load_proj() {
  const auto& loaded = loaded_functions<ProjLibrary>(WEFT_PROJ_SONAME);
  if (loaded) return {};
  return fail(ExitCode::kInternal,
              loaded.error() + "; weft projects longitude and latitude with PROJ");
}

const ProjLibrary& loaded_proj() {
  return *loaded_functions<ProjLibrary>(WEFT_PROJ_SONAME);
}

}  // namespace weft::files
