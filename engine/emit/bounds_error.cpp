// SPDX-License-Identifier: Apache-2.0
#include "engine/emit/bounds_error.h"

#include <cstdint>
#include <string>

#include "engine/base/text.h"

namespace weft {

std::optional<Error> bounds_error(const Summary& summary, double min_angle_deg) {
  const Unrefined& unrefined = summary.unrefined;
  const std::uint64_t count = unrefined.without_exemption();
  if (count == 0) return std::nullopt;

  const std::string angle = "the minimum angle of " + text(min_angle_deg) + " degrees";
  const std::string their = count == 1 ? "its" : "their";
  std::string bound = "the bound on " + their + " area";
  if (unrefined.too_large == 0) {
    bound = angle;
  } else if (unrefined.too_large < count) {
    bound += " (" + std::to_string(unrefined.too_large) + ") or " + angle;
  }
  std::string why;
  if (unrefined.precision > 0) why = "double precision ends";
  if (unrefined.precision > 0 && unrefined.streaming > 0) why += ", or because ";
  if (unrefined.streaming > 0)
    why += std::string("what is around ") + (count == 1 ? "it" : "them") + " had been sent already";
  // Where only the angle is missed, features of the domain are as near together as its digits
  // allow.
  const std::string remedy = unrefined.precision > 0 && unrefined.too_large == 0
                                 ? "; a larger snap merges what lies too near together"
                                 : "";
  return Error{ErrorCode::kBoundsNotMet, "",
               std::to_string(count) + (count == 1 ? " triangle misses " : " triangles miss ") +
                   bound + " because " + why + "; the first is at (" +
                   text(summary.unrefined_at.x) + ", " + text(summary.unrefined_at.y) + ")" +
                   remedy,
               summary.unrefined_at};
}

}  // namespace weft
