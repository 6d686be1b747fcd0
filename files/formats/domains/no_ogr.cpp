// SPDX-License-Identifier: Apache-2.0
// Takes the place of ogr.cpp in a build without GDAL.
#include "files/formats/domains/ogr.h"

namespace weft::files {

Result<Domain> read_with_ogr(const DomainFormat&, const std::filesystem::path& path,
                             const LayerOptions&) {
  return fail(ExitCode::kUnreadableInput,
              path.string() + ": this weft was built without GDAL, which reads such files");
}

bool are_same(const CoordinateSystem& a, const CoordinateSystem& b) {
  return (a.geographic && b.geographic) || a.definition == b.definition;
}

}  // namespace weft::files
