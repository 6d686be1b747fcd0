// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/arrangement/arrangement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <sstream>

#include "engine/domain/arrangement/snapping.h"
#include "engine/domain/tolerance.h"
#include "engine/domain/triangulation/segment_inserter.h"
#include "engine/domain/triangulation/triangulation.h"
#include "engine/domain/validate.h"

namespace weft {
namespace {

// The finite part of the triangulation in plain arrays; vertices in the order of their ids.
Arrangement extract(const std::vector<Point>& points, const Triangulation& t,
                    SegmentInserter& segments, StopPoller& poller) {
  const std::size_t inputs = points.size();
  std::vector<std::uint32_t> vertex_of_id(inputs + segments.crossings(), kNone);
  for (Triangulation::Vertex v = 0; v < t.vertices(); ++v) {
    poller.step();
    if (t.exists(v)) vertex_of_id[t.id(v)] = v;
  }
  Arrangement result;
  result.vertices.reserve(vertex_of_id.size());
  result.input_point.reserve(vertex_of_id.size());
  std::vector<std::uint32_t> number(t.vertices(), kNone);
  for (std::uint32_t id = 0; id < vertex_of_id.size(); ++id) {
    poller.step();
    const std::uint32_t v = vertex_of_id[id];
    if (v == kNone) continue;
    number[v] = static_cast<std::uint32_t>(result.vertices.size());
    result.input_point.push_back(id < inputs ? id : kNone);
    result.vertices.push_back(id < inputs ? points[id] : t.at(v));  // the first of 0 and -0
  }

  std::vector<std::uint32_t> face_number(t.faces());
  std::uint32_t faces = 0;
  for (std::uint32_t f = 0; f < t.faces(); ++f) {
    poller.step();
    face_number[f] = t.is_infinite(f) ? kNone : faces++;
  }
  result.triangles.reserve(faces);
  for (std::uint32_t f = 0; f < t.faces(); ++f) {
    poller.step();
    if (face_number[f] == kNone) continue;
    Arrangement::Triangle& to = result.triangles.emplace_back();
    for (int i = 0; i < 3; ++i) {
      to.vertex[i] = number[t.vertex(f, i)];
      to.neighbor[i] = face_number[t.mirror({f, i}).face];
      to.constraint[i] = t.constraint({f, i});
    }
  }
  result.constraints = segments.take_constraints();
  result.area_joins = segments.take_area_joins();
  return result;
}

}  // namespace

Error closed_by_merging(const Merging& merging) {
  std::ostringstream message;
  message.precision(17);
  message << "merging what is nearer than " << merging.tolerance
          << " has closed the domain, so there is nothing to mesh";
  return {ErrorCode::kEmptyDomain, "domain.segments", message.str()};
}

std::uint64_t estimated_bytes(std::uint64_t vertices, std::uint64_t edges) {
  return 240 * vertices + 40 * edges;
}

Arrangement arrange(const Pslg& pslg, StopPoller& poller, std::uint64_t max_splits) {
  poller.require(estimated_bytes(pslg.points.size(), pslg.segments.size()));
  Merging merging{.tolerance = merge_tolerance(pslg)};
  std::optional<Triangulation> triangulation;
  const auto build = [&](const std::vector<Point>& points) {
    const Span span = spanning_points(points, poller);
    if (span.size < 3) throw Stopped{closed_by_merging(merging)};
    triangulation.emplace(poller).build(points, span.point[0], span.point[1], span.point[2]);
  };
  // In most cases the triangulation shows that there is nothing to merge.
  std::vector<Point> merged;
  const std::vector<Point>* points = &pslg.points;
  const bool wants_snapping = pslg.snap == merging.tolerance;
  double spacing2 = 0;
  if (!wants_snapping) {
    build(pslg.points);
    spacing2 = triangulation->nearest2();
  }
  if (wants_snapping || spacing2 < merging.tolerance * merging.tolerance) {
    merged = merge_points(pslg.points, merging, poller);
    points = &merged;
    build(merged);
    spacing2 = 0;
  }
  const double spacing = std::max(merging.tolerance, std::sqrt(spacing2));
  SegmentInserter segments(pslg, *points, *triangulation, spacing, max_splits, merging, poller);
  segments.insert_all();
  Arrangement result = extract(*points, *triangulation, segments, poller);
  result.merging = merging;
  return result;
}

}  // namespace weft
