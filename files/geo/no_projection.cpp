// SPDX-License-Identifier: Apache-2.0
// Projections of a weft that was built without PROJ: there are none.
#include "files/base/text.h"
#include "files/geo/projection.h"

namespace weft::files {

struct Projection::Proj {
  std::string name;
};

bool Projection::available() {
  return false;
}

Result<Projection> Projection::make(const std::string& name) {
  return fail(ExitCode::kUsage,
              in_quotes(name) + " needs PROJ, and this weft was built without PROJ");
}

Projection::Projection(std::unique_ptr<Proj> proj) : proj_(std::move(proj)) {}
Projection::Projection(Projection&&) noexcept = default;
Projection& Projection::operator=(Projection&&) noexcept = default;
Projection::~Projection() = default;

const std::string& Projection::name() const {
  return proj_->name;
}
Point Projection::forward(Point lonlat) const {
  return lonlat;
}
Point Projection::inverse(Point metres) const {
  return metres;
}
Projection::Distortion Projection::distortion_at(Point) const {
  return {};
}

}  // namespace weft::files
