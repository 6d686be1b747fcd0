// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres/libpq.h"

namespace weft::server::postgres {

StoreResult<void> load_libpq() {
  const auto& loaded = loaded_functions<LibPq>(WEFT_LIBPQ_SONAME);
  if (loaded) return {};
  return tl::unexpected(
      StoreError{StoreErrorKind::kBroken, loaded.error() + "; weftd needs it for PostgreSQL"});
}

const LibPq& libpq() {
  return *loaded_functions<LibPq>(WEFT_LIBPQ_SONAME);
}

}  // namespace weft::server::postgres
