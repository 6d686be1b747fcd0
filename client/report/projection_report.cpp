// SPDX-License-Identifier: Apache-2.0
#include "client/report/projection_report.h"

#include <cstdio>

#include "files/base/text.h"

namespace weft::client {

std::string projection_text(const DomainProjection& projection) {
  char scales[96];
  std::snprintf(scales, sizeof scales,
                ", lengths in the plane are %.4g to %.4g of those on the ground\n",
                projection.distortion().least_scale, projection.distortion().greatest_scale);
  return "projected by " + harmless(projection.name()) + scales;
}

Json projection_json(const DomainProjection& projection) {
  return {{"name", projection.name()},
          {"least_scale", projection.distortion().least_scale},
          {"greatest_scale", projection.distortion().greatest_scale},
          {"angle_deg", projection.distortion().angle_deg}};
}

void bring_places_back(const DomainProjection& projection, v1::Summary& summary) {
  if (v1::Unrefined& unrefined = *summary.mutable_unrefined();
      unrefined.precision() + unrefined.streaming() > 0) {
    const Point at = projection.named_place({unrefined.x(), unrefined.y()});
    unrefined.set_x(at.x);
    unrefined.set_y(at.y);
  }
  if (v1::Unrefined& unrefined = *summary.mutable_unrefined(); unrefined.kept() > 0) {
    const Point at = projection.named_place({unrefined.kept_x(), unrefined.kept_y()});
    unrefined.set_kept_x(at.x);
    unrefined.set_kept_y(at.y);
  }
  if (summary.has_outside()) {
    v1::OutsideSegments& outside = *summary.mutable_outside();
    const Point at = projection.named_place({outside.x(), outside.y()});
    outside.set_x(at.x);
    outside.set_y(at.y);
  }
  if (summary.has_narrow()) {
    v1::NarrowPlace& narrow = *summary.mutable_narrow();
    const Point at = projection.named_place({narrow.x(), narrow.y()});
    narrow.set_x(at.x);
    narrow.set_y(at.y);
  }
  if (summary.has_layers()) {
    v1::LayerSummary& layers = *summary.mutable_layers();
    const Point at = projection.named_place({layers.x(), layers.y()});
    layers.set_x(at.x);
    layers.set_y(at.y);
  }
  for (int i = 0; i + 1 < summary.simplification().cuts_size(); i += 2) {
    v1::Simplification& simplified = *summary.mutable_simplification();
    const Point at = projection.named_place({simplified.cuts(i), simplified.cuts(i + 1)});
    simplified.set_cuts(i, at.x);
    simplified.set_cuts(i + 1, at.y);
  }
  v1::Merging& merging = *summary.mutable_merging();
  if (merging.farthest() > 0) {
    const Point at = projection.named_place({merging.farthest_x(), merging.farthest_y()});
    merging.set_farthest_x(at.x);
    merging.set_farthest_y(at.y);
  }
  if (merging.vanished_faces() > 0) {
    const Point at = projection.named_place({merging.vanished_x(), merging.vanished_y()});
    merging.set_vanished_x(at.x);
    merging.set_vanished_y(at.y);
  }
}

}  // namespace weft::client
