// SPDX-License-Identifier: Apache-2.0
#include "engine/refine/quality_bounds.h"

#include <sleef.h>

namespace weft {

QualityBounds QualityBounds::from(double min_angle_deg, double min_edge, double precision) {
  // The C library's sine may differ in its last bit from machine to machine; this one does not.
  constexpr double kRadians = 3.14159265358979323846 / 180;
  const double sine = Sleef_cinz_sind1_u10purec(min_angle_deg * kRadians);
  const double cosine = std::sqrt(1 - sine * sine);
  QualityBounds bounds;
  bounds.sin2 = sine * sine;
  // Üngör's off-centre: the apex over the shortest edge whose angle is the bound, a little inside.
  bounds.off_centre = min_angle_deg > 0 ? 0.495 * std::sqrt((1 + cosine) / (1 - cosine)) : 0;
  bounds.min_edge2 = min_edge * min_edge;
  bounds.lens = lens_for(sine);
  constexpr double kMinSin2 = 0.01;  // 5.7 degrees, or nothing would keep points off
  const double cosine_at_kept = 1 - 2 * std::max(bounds.sin2, kMinSin2);
  bounds.kept_lens = cosine_at_kept * cosine_at_kept;
  bounds.precision2 = precision * precision;
  bounds.min_length2 = std::max(bounds.min_edge2, bounds.precision2);
  return bounds;
}

}  // namespace weft
