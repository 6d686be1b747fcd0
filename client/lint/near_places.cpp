// SPDX-License-Identifier: Apache-2.0
#include "client/lint/near_places.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "files/base/text.h"
#include "files/lint/domain_lint.h"

namespace weft::client {

std::string near_places_text(const Domain& domain, const DataPath& file,
                             const v1::Summary& summary) {
  // Of larger domains lint takes longer than the mesh.
  constexpr std::size_t kMaxSegments = 1'000'000;
  if (summary.unrefined().small_input_angle() == 0 || summary.has_narrow() ||
      domain.segments.size() > kMaxSegments)
    return "";
  const auto lint = lint_domain(domain, file, {});
  if (!lint) return "";
  constexpr std::array<std::string_view, 3> kNear = {"gap", "near-points", "near-segment"};
  std::size_t places = 0;
  const Finding* farthest = nullptr;
  for (const Finding& finding : lint->findings) {
    const bool is_near = std::ranges::find(kNear, finding.kind) != kNear.end();
    if (!is_near || !finding.measure || !finding.remedy.starts_with("--snap ")) continue;
    ++places;
    if (farthest == nullptr || *finding.measure > *farthest->measure) farthest = &finding;
  }
  if (farthest == nullptr) return "";
  const std::string remedy = farthest->remedy.substr(0, farthest->remedy.find(' ', 7));
  return with_separators(places) +
         (places == 1 ? " point of the input is " : " points of the input are up to ") +
         digits(*farthest->measure, 3) + " off others or off segments: if they should be one, " +
         remedy + " merges them\n";
}

}  // namespace weft::client
