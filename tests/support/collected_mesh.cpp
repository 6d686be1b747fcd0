// SPDX-License-Identifier: Apache-2.0
#include "tests/support/collected_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "checker/domain/tolerance.h"
#include "checker/size/size.h"

namespace weft {
namespace {

// A histogram counted anew. What lies on the border of two bins, as far as double precision tells,
// may be in either.
class Recount {
 public:
  // Bin i ends at ends[i], the last one nowhere.
  explicit Recount(std::vector<double> ends) : ends_(std::move(ends)), counts_(ends_.size() + 1) {}

  void add(double value) {
    const auto end = std::upper_bound(ends_.begin(), ends_.end(), value);
    ++counts_[static_cast<std::size_t>(end - ends_.begin())];
    const auto on_border = [value](double e) { return std::fabs(value - e) <= 1e-9 * e; };
    if (std::any_of(ends_.begin(), ends_.end(), on_border)) ++on_borders_;
  }

  template <class Histogram>
  bool agrees_with(const Histogram& histogram) const {
    std::uint64_t apart = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i)
      apart += histogram[i] > counts_[i] ? histogram[i] - counts_[i] : counts_[i] - histogram[i];
    return histogram.size() == counts_.size() && apart <= 2 * on_borders_;
  }

 private:
  const std::vector<double> ends_;
  std::vector<std::uint64_t> counts_;
  std::uint64_t on_borders_ = 0;
};

// What is wrong with the histograms, or "".
std::string miscounted(const MeshRequest& request, const check::Mesh& mesh,
                       const Summary& summary) {
  Recount angles({10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110, 120, 130, 140, 150, 160, 170});
  Recount aspects({1.1, 1.25, 1.5, 2, 3, 5, 10, 100});
  Recount sizes({0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9});
  const bool bounded_by_regions =
      std::any_of(request.pslg.regions.begin(), request.pslg.regions.end(),
                  [](const RegionSeed& r) { return r.max_area.has_value(); }) ||
      std::any_of(request.pslg.areas.begin(), request.pslg.areas.end(),
                  [](const Area& a) { return a.max_area.has_value(); });
  // Sizes at markers, with a gradation, lower the size beside them; so do edges across.
  const bool varies =
      request.size.cells_across > 0 || (request.size.gradation > 0 && !request.size.at.empty());
  const auto* const constant = request.size.measure == Measure::kArea && !varies
                                   ? std::get_if<double>(&request.size.value)
                                   : nullptr;
  constexpr double kStep = 0.1;  // degrees: what the percentile is rounded by
  double below_percentile = 0;
  double up_to_percentile = 0;
  for (const auto& t : mesh.triangles) {
    double length[3];
    double area = 0;
    double smallest = 180;
    for (int k = 0; k < 3; ++k) {
      const check::Vec2 a = mesh.vertices[t[k]];
      const check::Vec2 b = mesh.vertices[t[(k + 1) % 3]];
      const check::Vec2 c = mesh.vertices[t[(k + 2) % 3]];
      // Of a flat triangle it may round to less than 0.
      const double cross = std::max((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x), 0.0);
      const double dot = (b.x - a.x) * (c.x - a.x) + (b.y - a.y) * (c.y - a.y);
      const double angle = std::atan2(cross, dot) * (180 / std::acos(-1.0));
      angles.add(angle);
      smallest = std::min(smallest, angle);
      length[k] = std::hypot(b.x - a.x, b.y - a.y);
      if (k == 0) area = 0.5 * cross;
    }
    below_percentile += smallest < summary.min_angle_p1_deg - kStep ? 1 : 0;
    up_to_percentile += smallest < summary.min_angle_p1_deg + kStep ? 1 : 0;
    const double inradius = 2 * area / (length[0] + length[1] + length[2]);
    aspects.add(std::max({length[0], length[1], length[2]}) / (2 * std::sqrt(3.0) * inradius));
    if (constant) sizes.add(area / *constant);
  }
  if (!angles.agrees_with(summary.angle_histogram)) return "the summary miscounts angles";
  if (!aspects.agrees_with(summary.aspect_histogram)) return "the summary miscounts aspect ratios";
  if (constant && !bounded_by_regions && !sizes.agrees_with(summary.size_histogram))
    return "the summary miscounts sizes";
  const double rank = 0.01 * static_cast<double>(mesh.triangles.size());
  if (!(below_percentile <= rank && rank <= up_to_percentile))
    return "the summary mistakes the percentile of the smallest angles";
  return "";
}

// What rounding explains of an angle, in degrees: the area of its triangle is off by 2^-51 or so of
// the longest edges' product, which in a needle is much of the product of the edges at the angle.
double angle_rounding(const check::Mesh& mesh) {
  double result = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const check::Vec2 p = mesh.vertices[a], q = mesh.vertices[b], r = mesh.vertices[c];
    const auto [shortest, longest] =
        std::minmax({std::hypot(q.x - p.x, q.y - p.y), std::hypot(r.x - p.x, r.y - p.y),
                     std::hypot(r.x - q.x, r.y - q.y)});
    result = std::max(result, longest / shortest);
  }
  return 1e-9 + 0x1p-50 * result * (180 / std::acos(-1.0));
}

// What rounding explains of a triangle's area: of the products of its edges, which cancel in a
// needle.
double area_rounding(check::Vec2 p, check::Vec2 q, check::Vec2 r) {
  const double longest =
      std::max({std::hypot(q.x - p.x, q.y - p.y), std::hypot(r.x - p.x, r.y - p.y),
                std::hypot(r.x - q.x, r.y - q.y)});
  return 4 * 0x1p-53 * longest * longest;
}

double area_rounding(const check::Mesh& mesh) {
  double result = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    result += area_rounding(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
  return result;
}

}  // namespace

bool CollectedMesh::accept(Chunk&& chunk) {
  must(chunk.index == chunks, "chunks come in order");
  must(chunk.first_vertex == mesh.vertices.size(), "vertices are numbered without gaps");
  must(chunk.first_triangle == mesh.triangles.size(), "triangles are numbered without gaps");
  must(chunk.digest == chunk_digest(chunk), "the digest is that of the chunk");
  must(chunk.coordinates.size() * 8 + chunk.triangles.size() * 4 + chunk.regions.size() * 4 +
               chunk.edges.size() * 16 + chunk.bulges.size() * 8 + chunk.input_points.size() * 8 <=
           kMaxChunkBytes,
       "a chunk is at most kMaxChunkBytes");
  ++chunks;
  for (std::size_t i = 0; i + 1 < chunk.coordinates.size(); i += 2) {
    mesh.vertices.push_back({chunk.coordinates[i], chunk.coordinates[i + 1]});
  }
  const auto known = [&](std::uint32_t v) { return v < mesh.vertices.size(); };
  for (std::size_t i = 0; i + 2 < chunk.triangles.size(); i += 3) {
    const auto* t = &chunk.triangles[i];
    must(known(t[0]) && known(t[1]) && known(t[2]), "triangles do not refer ahead");
    mesh.triangles.push_back({t[0], t[1], t[2]});
    for (int k = 0; k < 3 && known(t[k]); ++k) {
      const check::Vec2 p = mesh.vertices[t[k]];
      must(p.x >= chunk.box.min_x && p.x <= chunk.box.max_x && p.y >= chunk.box.min_y &&
               p.y <= chunk.box.max_y,
           "the box holds the chunk's triangles");
    }
  }
  mesh.regions.resize(chunk.first_triangle, 0);
  mesh.regions.insert(mesh.regions.end(), chunk.regions.begin(), chunk.regions.end());
  mesh.regions.resize(mesh.triangles.size(), 0);
  for (const Chunk::Edge& e : chunk.edges) {
    must(known(e.a) && known(e.b), "edges do not refer ahead");
    mesh.edges.push_back({e.a, e.b, e.marker});
  }
  must(chunk.bulges.empty() || chunk.bulges.size() == chunk.edges.size(), "an edge has one bulge");
  mesh.bulges.insert(mesh.bulges.end(), chunk.bulges.begin(), chunk.bulges.end());
  mesh.bulges.resize(mesh.edges.size(), 0);
  for (const auto& pair : chunk.input_points) mesh.input_points.push_back(pair);
  return true;
}

void CollectedMesh::must(bool holds, const char* law) {
  if (!holds && broken_law.empty()) broken_law = law;
}

check::Domain domain_of(const Pslg& pslg) {
  check::Domain domain;
  for (Point p : pslg.points) domain.points.push_back({p.x, p.y});
  for (const Segment& s : pslg.segments) {
    domain.segments.push_back({s.a, s.b});
    domain.markers.push_back(s.marker);
    if (!pslg.areas.empty()) domain.segment_areas.push_back(s.area == kNone ? 0 : s.area + 1);
  }
  for (Point p : pslg.holes) domain.holes.push_back({p.x, p.y});
  for (const RegionSeed& r : pslg.regions) {
    domain.regions.push_back({{r.at.x, r.at.y}, r.id, r.max_area});
  }
  for (const Area& area : pslg.areas)
    domain.areas.push_back({area.region, area.priority, area.max_area, area.is_hole});
  for (const Arc& arc : pslg.arcs) domain.arcs.push_back({arc.segment, arc.bulge});
  domain.fill = pslg.fill == Fill::kSeeds     ? check::Fill::kSeeds
                : pslg.fill == Fill::kEvenOdd ? check::Fill::kEvenOdd
                                              : check::Fill::kUnion;
  domain.snap = pslg.snap;
  return domain;
}

namespace {

std::vector<check::Vec2> to_checker(const std::vector<Point>& points) {
  std::vector<check::Vec2> out;
  for (const Point p : points) out.push_back({p.x, p.y});
  return out;
}

struct FieldToChecker {
  using Kind = decltype(check::NamedField::kind);
  Kind operator()(const DistanceSpec& distance) const {
    return check::DistanceField{distance.markers, to_checker(distance.points), distance.segments};
  }
  Kind operator()(const FieldRaster& raster) const {
    return check::RasterField{{raster.origin.x, raster.origin.y},
                              raster.dx,
                              raster.dy,
                              raster.columns,
                              raster.rows,
                              raster.values};
  }
  Kind operator()(const FieldMesh& mesh) const {
    return check::MeshField{to_checker(mesh.vertices), mesh.triangles, mesh.values};
  }
  Kind operator()(const WidthSpec&) const { return check::WidthField{}; }
};

struct ValueToChecker {
  using Value = check::SizeSpec::Value;
  Value operator()(std::monostate) const { return {}; }
  Value operator()(double constant) const { return constant; }
  Value operator()(const std::string& expression) const { return expression; }
  Value operator()(const Raster& raster) const {
    return check::Raster{{raster.origin.x, raster.origin.y},
                         raster.dx,
                         raster.dy,
                         raster.columns,
                         raster.rows,
                         raster.values};
  }
};

check::SizeSpec to_checker(const SizeSpec& size) {
  check::SizeSpec out;
  out.value = std::visit(ValueToChecker{}, size.value);
  if (size.measure == Measure::kEdge) out.measure = check::Measure::kEdge;
  for (const FieldSpec& field : size.fields)
    out.fields.push_back({field.name, std::visit(FieldToChecker{}, field.kind)});
  out.gradation = size.gradation;
  out.gradation_within = size.gradation_within;
  for (const SizeAt& at : size.at) out.at.push_back({at.marker, at.max_edge});
  return out;
}

// What rounding explains of the sum of area / size, as a share of it: that of the areas, and that
// of the centroids, because a size that jumps, or is steep, has several values within a few ulps.
double share_rounding(const check::SizeSpec& spec, const check::Domain& domain,
                      const check::Mesh& mesh) {
  const auto size = check::size_function(spec, domain);
  if (!size) return 0;
  const auto value = [&](check::Vec2 p) { return *size ? (*size)(p) : 1.0; };
  double sum = 0;
  double unsure = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const check::Vec2 p = mesh.vertices[a], q = mesh.vertices[b], r = mesh.vertices[c];
    const check::Vec2 centroid{(p.x + q.x + r.x) / 3, (p.y + q.y + r.y) / 3};
    const double step = 0x1p-49 * std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(q.x),
                                            std::fabs(q.y), std::fabs(r.x), std::fabs(r.y)});
    double least = std::numeric_limits<double>::infinity();
    double most = 0;
    for (const double dx : {-step, 0.0, step}) {
      for (const double dy : {-step, 0.0, step}) {
        const double there = value({centroid.x + dx, centroid.y + dy});
        if (!(there > 0)) continue;
        least = std::min(least, there);
        most = std::max(most, there);
      }
    }
    if (most == 0) continue;
    const double area = 0.5 * ((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x));
    sum += area / most;
    unsure += area / least - area / most + area_rounding(p, q, r) / least;
  }
  return sum > 0 ? unsure / sum : 0;
}

// What merging explains of the number of triangles with a bound, as a share of it: which region a
// triangle lies in that is as flat as features are merged, the checker cannot tell.
double region_rounding(const MeshRequest& request, const check::Domain& domain,
                       const check::Mesh& mesh) {
  const auto is_bounded = [&](std::int32_t region) {
    return std::any_of(request.pslg.areas.begin(), request.pslg.areas.end(),
                       [](const Area& area) { return area.max_area.has_value(); }) ||
           std::any_of(request.pslg.regions.begin(), request.pslg.regions.end(),
                       [&](const RegionSeed& seed) { return seed.id == region && seed.max_area; });
  };
  const double flat = check::kMaxBend * check::merging_distance(domain);
  double bounded = 0;
  double unsure = 0;
  for (std::size_t t = 0; t < mesh.regions.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const check::Vec2 p = mesh.vertices[a], q = mesh.vertices[b], r = mesh.vertices[c];
    const double longest =
        std::max({std::hypot(q.x - p.x, q.y - p.y), std::hypot(r.x - q.x, r.y - q.y),
                  std::hypot(p.x - r.x, p.y - r.y)});
    bounded += is_bounded(mesh.regions[t]) ? 1 : 0;
    unsure += (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x) <= flat * longest ? 1 : 0;
  }
  return bounded > 0 ? unsure / bounded : 0;
}

std::vector<check::LayerRows> layers_of(const MeshRequest& request) {
  std::int32_t highest = 0;
  for (const RegionSeed& seed : request.pslg.regions) highest = std::max(highest, seed.id);
  for (const Area& area : request.pslg.areas) highest = std::max(highest, area.region.value_or(0));
  std::vector<check::LayerRows> all;
  for (const Layers& layers : request.layers)
    all.push_back({layers.marker, layers.first, layers.ratio, layers.rows,
                   layers.region.value_or(highest + 1)});
  return all;
}

check::Mesh without(const std::vector<check::LayerRows>& layers, const check::Mesh& mesh) {
  check::Mesh rest = mesh;
  rest.triangles.clear();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (std::none_of(layers.begin(), layers.end(),
                     [&](const auto& rows) { return rows.region == mesh.regions[t]; }))
      rest.triangles.push_back(mesh.triangles[t]);
  return rest;
}

}  // namespace

std::string verdict(const MeshRequest& request, const CollectedMesh& collected,
                    const Summary& summary) {
  if (!collected.broken_law.empty()) return "broken law: " + collected.broken_law;
  check::Requirements requirements;
  requirements.size = to_checker(request.size);
  requirements.min_angle_deg = request.min_angle_deg;
  requirements.simplify = request.simplify;
  requirements.points_per_circle = request.size.points_per_circle;
  // What the engine declares it could not refine may miss its bounds, no more.
  requirements.keep = request.keep;
  for (const PeriodicPair& pair : request.periodic)
    requirements.periodic.push_back({pair.from, pair.to});
  requirements.allowed_unrefined = summary.unrefined.edge_floor + summary.unrefined.kept +
                                   summary.unrefined.budget + summary.unrefined.without_exemption();
  requirements.layers = layers_of(request);
  const check::Domain domain = domain_of(request.pslg);
  const check::Report report = check::check(domain, collected.mesh, requirements);
  if (!report.ok()) return check::to_text(report);
  const auto near = [](double a, double b, double by) { return std::fabs(a - b) <= by; };
  if (!near(summary.mean_quality, report.facts.mean_quality, 1e-9))
    return "the summary mistakes the mean quality";
  const double ratio = report.facts.ideal_ratio.value_or(0);
  // Of what is larger than its bound, the checker takes the largest bound near by. With a gradation
  // the checker knows the limit from the centroids alone, so its bounds may be larger.
  const auto is_right = [&](double error) {
    return request.size.gradation > 0 ? summary.ideal_ratio <= ratio * (1 + error)
                                      : near(summary.ideal_ratio, ratio, error * ratio);
  };
  if (report.facts.unrefined == 0 && !is_right(1e-6) &&
      !is_right(1e-6 + share_rounding(requirements.size, domain, collected.mesh) +
                region_rounding(request, domain, collected.mesh)))
    return "the summary mistakes the least number of triangles";
  if (request.simplify > 0) {
    if (!summary.simplified) return "the summary does not tell what was simplified";
    if (!near(summary.simplified->area, *report.facts.area_change, 1e-9 * report.facts.area))
      return "the summary mistakes the change of the area";
  }
  if (summary.triangles != report.facts.triangles) return "the summary miscounts triangles";
  if (summary.vertices != report.facts.vertices) return "the summary miscounts vertices";
  if (summary.edges != report.facts.edges) return "the summary miscounts edges";
  const check::Mesh outside = without(requirements.layers, collected.mesh);
  if (request.layers.empty() != !summary.layers.has_value() ||
      (summary.layers &&
       summary.layers->triangles != collected.mesh.triangles.size() - outside.triangles.size()))
    return "the summary miscounts the triangles of layers";
  const double angle_error = angle_rounding(outside);
  if (!near(summary.min_angle_deg, report.facts.min_angle_deg, angle_error))
    return "the summary has another smallest angle";
  if (!near(summary.max_angle_deg, report.facts.max_angle_deg, angle_error))
    return "the summary has another largest angle";
  if (std::fabs(summary.area - report.facts.area) >
      1e-9 * report.facts.area + area_rounding(collected.mesh))
    return "the summary has another area";
  if (auto wrong = miscounted(request, outside, summary); !wrong.empty()) return wrong;
  for (const auto& [vertex, point] : collected.mesh.input_points) {
    if (vertex >= collected.mesh.vertices.size() || point >= request.pslg.points.size())
      return "an input point is out of range";
    const check::Vec2 v = collected.mesh.vertices[vertex];
    if (v.x != request.pslg.points[point].x || v.y != request.pslg.points[point].y)
      return "an input point is not where it was";
  }
  return "";
}

}  // namespace weft
