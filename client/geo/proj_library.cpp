// SPDX-License-Identifier: Apache-2.0
#include "client/geo/proj_library.h"

#include <string>

namespace weft::client {
namespace {

const tl::expected<ProjLibrary, std::string>& loaded() {
  static const auto proj = load_functions<ProjLibrary>(WEFT_PROJ_SONAME);
  return proj;
}

}  // namespace

Result<void> load_proj() {
  if (loaded()) return {};
  return fail(ExitCode::kInternal,
              loaded().error() + "; weft projects longitude and latitude with PROJ");
}

const ProjLibrary& loaded_proj() {
  return *loaded();
}

}  // namespace weft::client
