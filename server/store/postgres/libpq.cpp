// SPDX-License-Identifier: Apache-2.0
#include "server/store/postgres/libpq.h"

#include <string>

namespace weft::server::postgres {
namespace {

const tl::expected<LibPq, std::string>& loaded() {
  static const auto functions = load_functions<LibPq>(WEFT_LIBPQ_SONAME);
  return functions;
}

}  // namespace

StoreResult<void> load_libpq() {
  if (loaded()) return {};
  return tl::unexpected(
      StoreError{StoreErrorKind::kBroken, loaded().error() + "; weftd needs it for PostgreSQL"});
}

const LibPq& libpq() {
  return *loaded();
}

}  // namespace weft::server::postgres
