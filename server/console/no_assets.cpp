// SPDX-License-Identifier: Apache-2.0
// For a weftd without the application.
#include "server/console/assets.h"

namespace weft::server {

std::span<const Asset> console_assets() {
  return {};
}

}  // namespace weft::server
