// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include "engine/base/context.h"
#include "engine/base/text.h"
#include "engine/domain/stop_poller.h"
#include "engine/domain/validate.h"
#include "weft/weft.h"

namespace weft {

namespace {

std::optional<Error> check_periodic(const MeshRequest& request) {
  const auto bad = [](const std::string& field, const std::string& message) {
    return Error{ErrorCode::kBadOption, field, message};
  };
  if (request.periodic.size() > kMaxPeriodicPairs)
    return bad("quality.periodic",
               "quality.periodic has " + std::to_string(request.periodic.size()) +
                   " pairs; it must have at most " + std::to_string(kMaxPeriodicPairs));
  if (request.simplify > 0 && !request.periodic.empty())
    return bad("quality.periodic", "quality.periodic needs sides as they are, but simplify is " +
                                       text(request.simplify));
  for (std::size_t i = 0; i < request.periodic.size() && request.keep; ++i) {
    for (const std::int32_t marker : {request.periodic[i].from, request.periodic[i].to}) {
      const auto& keep = *request.keep;
      if (!keep.empty() && std::find(keep.begin(), keep.end(), marker) == keep.end()) continue;
      const std::string field = "quality.periodic[" + std::to_string(i) + "]";
      return bad(field, field + " splits segments with marker " + std::to_string(marker) +
                            ", which quality.keep keeps as they are");
    }
  }
  return std::nullopt;
}

std::optional<Error> check_layers(const MeshRequest& request) {
  const auto bad = [](const std::string& message) {
    return Error{ErrorCode::kBadOption, message.substr(0, message.find(' ')), message};
  };
  if (request.layers.empty()) return std::nullopt;
  if (request.layers.size() > kMaxLayers)
    return bad("quality.layers has " + std::to_string(request.layers.size()) +
               " entries; it must have at most " + std::to_string(kMaxLayers));
  if (request.simplify > 0)
    return bad("quality.layers lie along walls as they are, but simplify is " +
               text(request.simplify));
  if (!request.periodic.empty()) return bad("quality.layers exclude quality.periodic");
  for (std::size_t i = 0; i < request.layers.size(); ++i) {
    const Layers& layers = request.layers[i];
    const std::string field = "quality.layers[" + std::to_string(i) + "]";
    if (!(layers.first > 0 && std::isfinite(layers.first)))
      return bad(field + ".first is " + text(layers.first) + "; it must be above 0, and finite");
    if (!(layers.ratio >= 1 && layers.ratio <= kMaxLayerRatio))
      return bad(field + ".ratio is " + text(layers.ratio) + "; it must be from 1 to " +
                 text(kMaxLayerRatio));
    if (!(layers.rows >= 1 && layers.rows <= kMaxLayerRows))
      return bad(field + ".rows is " + std::to_string(layers.rows) + "; it must be from 1 to " +
                 std::to_string(kMaxLayerRows));
    double thickness = 0, height = layers.first;
    for (std::uint32_t row = 0; row < layers.rows; ++row, height *= layers.ratio)
      thickness += height;
    if (!(thickness <= kMaxMagnitude))
      return bad(field + " is " + text(thickness) + " thick; it must be at most " +
                 text(kMaxMagnitude));
    const std::string marker = std::to_string(layers.marker);
    for (std::size_t k = 0; k < i; ++k)
      if (request.layers[k].marker == layers.marker)
        return bad(field + ".marker is " + marker + ", which other layers have");
    if (!request.keep) continue;
    const auto& keep = *request.keep;
    if (keep.empty() || std::find(keep.begin(), keep.end(), layers.marker) != keep.end())
      return bad(field + " splits segments with marker " + marker +
                 ", which quality.keep keeps as they are");
  }
  return std::nullopt;
}

}  // namespace

std::optional<Error> check_options(const MeshRequest& request) {
  const auto bad = [](const std::string& field, const std::string& value, const char* range) {
    return Error{ErrorCode::kBadOption, field, field + " is " + value + "; it must be " + range};
  };
  if (!(request.min_angle_deg >= 0 && request.min_angle_deg <= kMaxMinAngleDeg)) {
    const std::string range = "from 0 to " + text(kMaxMinAngleDeg) + " degrees";
    return bad("quality.min_angle_deg", text(request.min_angle_deg), range.c_str());
  }
  if (!(request.min_edge >= 0 && std::isfinite(request.min_edge)))
    return bad("quality.min_edge", text(request.min_edge), "0 or more, and finite");
  if (request.sweeps.value_or(0) > kMaxSweeps) {
    const std::string range = "from 0 to " + std::to_string(kMaxSweeps) + " sweeps";
    return bad("quality.optimise", std::to_string(*request.sweeps), range.c_str());
  }
  if (!(request.simplify >= 0 && std::isfinite(request.simplify)))
    return bad("simplify", text(request.simplify), "0 or more, and finite");
  if (request.sample_points.size() > kMaxSamplePoints)
    return bad("sample_points", std::to_string(request.sample_points.size()) + " points",
               ("at most " + std::to_string(kMaxSamplePoints)).c_str());
  for (std::size_t i = 0; i < request.sample_points.size(); ++i) {
    const Point p = request.sample_points[i];
    if (!(std::fabs(p.x) <= kMaxMagnitude && std::fabs(p.y) <= kMaxMagnitude))
      return Error{ErrorCode::kBadCoordinate, "sample_points[" + std::to_string(i) + "]",
                   "sample_points[" + std::to_string(i) + "] is (" + text(p.x) + ", " + text(p.y) +
                       "); coordinates must be finite, and at most " + text(kMaxMagnitude)};
  }
  if (request.keep && request.keep->size() > kMaxKeptMarkers) {
    const std::string range = "at most " + std::to_string(kMaxKeptMarkers) + ", or none: all";
    return bad("quality.keep.markers", std::to_string(request.keep->size()) + " markers",
               range.c_str());
  }
  if (request.simplify > 0 && request.keep)
    return Error{
        ErrorCode::kBadOption, "quality.keep",
        "quality.keep keeps segments as they are, but simplify is " + text(request.simplify)};
  if (auto error = check_periodic(request)) return error;
  return check_layers(request);
}

std::optional<Error> check_pslg(const Pslg& pslg) {
  const ExecutionContext unbounded;
  StopPoller poller(unbounded);
  return validate(pslg, poller);
}

std::optional<Error> validate(const MeshRequest& request) {
  if (auto error = check_options(request)) return error;
  if (auto error = check_size(request.size)) return error;
  if (const auto* const raster = std::get_if<Raster>(&request.size.value)) {
    if (auto error = check_raster_values(raster->values, raster->columns)) return error;
  }
  return check_pslg(request.pslg);
}

}  // namespace weft
