// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/edge_limits.h"

#include <string>

#include "engine/base/text.h"

namespace weft {
namespace {

std::optional<Error> check_lengths(const MeshRequest& request, const EdgeLimits& limits,
                                   double least) {
  for (std::size_t i = 0; i < request.size.at.size(); ++i) {
    const SizeAt& at = request.size.at[i];
    const std::string path = "size.at[" + std::to_string(i) + "]";
    if (at.max_edge < least)
      return Error{ErrorCode::kBadOption, path + ".max_edge",
                   path + ".max_edge is " + text(at.max_edge) + "; it must be at least " +
                       text(least) + ", twice the shortest edge that refinement makes"};
    if (limits.keep(at.marker))
      return Error{ErrorCode::kBadOption, path + ".marker",
                   path + ".marker is " + std::to_string(at.marker) +
                       ", whose segments quality.keep keeps as they are"};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Error> check_edge_limits(const MeshRequest& request, const EdgeLimits& limits,
                                       double least) {
  if (auto error = check_lengths(request, limits, least)) return error;
  if (!request.keep) return std::nullopt;
  for (const Arc& arc : request.pslg.arcs)
    if (arc.bulge != 0 && limits.keep(request.pslg.segments[arc.segment].marker))
      return Error{ErrorCode::kBadOption, "quality.keep",
                   "quality.keep keeps straight segments, but segment " +
                       std::to_string(arc.segment) + " is an arc"};
  const auto missing = first_without_segment(*request.keep, request.pslg.segments);
  if (!missing) return std::nullopt;
  const std::string field = "quality.keep.markers[" + std::to_string(*missing) + "]";
  return Error{ErrorCode::kBadOption, field,
               field + " is " + std::to_string((*request.keep)[*missing]) +
                   ", which is the marker of no segment of the domain"};
}

}  // namespace weft
