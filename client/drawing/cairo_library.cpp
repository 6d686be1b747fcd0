// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/cairo_library.h"

#include <string>

namespace weft::client {
namespace {

const tl::expected<Cairo, std::string>& loaded() {
  static const auto cairo = load_functions<Cairo>(WEFT_CAIRO_SONAME);
  return cairo;
}

}  // namespace

Result<void> load_cairo() {
  if (loaded()) return {};
  return fail(ExitCode::kInternal, loaded().error() + "; weft draws with cairo");
}

const Cairo& loaded_cairo() {
  return *loaded();
}

}  // namespace weft::client
