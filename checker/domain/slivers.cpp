// SPDX-License-Identifier: Apache-2.0
#include "checker/domain/slivers.h"

#include <algorithm>
#include <cstdint>

namespace weft::check {

std::vector<char> find_slivers(const BentDomain& bent, const Arrangement& arrangement) {
  std::vector<double> slack(arrangement.faces().size(), 0);
  for (std::uint32_t h = 0; h < 2 * arrangement.edges().size(); ++h) {
    double& most = slack[arrangement.face(h)];
    most = std::max(most, bent.slack_of(arrangement.covers(h / 2)));
  }
  std::vector<char> result(slack.size(), 0);
  for (std::size_t f = 1; f < slack.size(); ++f) {
    const Arrangement::Face& face = arrangement.faces()[f];
    result[f] = face.area <= sliver_area(face.perimeter, slack[f]);
  }
  return result;
}

}  // namespace weft::check
