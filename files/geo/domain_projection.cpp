// SPDX-License-Identifier: Apache-2.0
#include "files/geo/domain_projection.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "files/base/text.h"
#include "files/geo/lonlat_extent.h"
#include "files/geo/segment_touches.h"

namespace weft::files {
namespace {

constexpr double kStraight = 1e-3;  // of the length of a piece
constexpr std::size_t kMaxPieces = 4096;
constexpr std::size_t kMaxAdded = 1'000'000;
constexpr std::size_t kMaxPairs = 20'000'000;  // looked at in a second or two
constexpr std::size_t kMaxArcs = 10'000;       // each becomes up to 180 chords
constexpr std::size_t kMaxSamples = 1000;

// To multiples of 1 / `per_unit`.
Point rounded(Point at, double per_unit) {
  return {std::nearbyint(at.x * per_unit) / per_unit, std::nearbyint(at.y * per_unit) / per_unit};
}

// Sines of two processors bring a point to places nanometres apart, so nearly always to the same
// one of these.
Point on_grid(Point metres) {
  return rounded(metres, 1 / kProjectedGrid);
}

// Projects points of one domain.
class Projecting {
 public:
  Projecting(const Projection& projection, const LonLatExtent& extent)
      : projection_(projection), extent_(extent) {}

  // Without what `checked` checks, and on no grid.
  Point forward(Point lonlat) const {
    return projection_.forward({extent_.unwrapped(lonlat.x), lonlat.y});
  }
  // On the grid. Returns an error if the projection does not map the point there and back.
  Result<Point> checked(Point lonlat, const Provenance& places, std::size_t i) const {
    constexpr double kNear = 1e-7;  // degrees: a centimetre
    const Point at = forward(lonlat);
    if (std::isfinite(at.x) && std::isfinite(at.y)) {
      const Point back = projection_.inverse(at);
      if (distance_deg(lonlat, back) <= kNear) return on_grid(at);
    }
    const std::string place = places.locate(i);
    return fail(ExitCode::kUnreadableInput,
                (place.empty() ? "" : place + ": ") + coordinates(lonlat.x, lonlat.y) +
                    " is outside of what " + in_quotes(projection_.name()) + " projects");
  }

 private:
  const Projection& projection_;
  const LonLatExtent& extent_;
};

// A point of the segment from a to b, at 0 to 1.
Point on_segment(Point a, Point b, double at) {
  return {a.x + longitude_step(a.x, b.x) * at, a.y + (b.y - a.y) * at};
}

// Whether the segment from a to b, divided into so many pieces, is straight enough in the plane.
bool are_straight(const Projecting& projecting, Point a, Point b, std::size_t pieces) {
  Point from = projecting.forward(a);
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    const auto place = [&](double within) {
      const double at = (static_cast<double>(piece) + within) / static_cast<double>(pieces);
      return projecting.forward(on_segment(a, b, at));
    };
    const Point to = place(1);
    const double dx = to.x - from.x;
    const double dy = to.y - from.y;
    for (const double within : {0.25, 0.5, 0.75}) {
      const Point at = place(within);
      const double away = std::abs((at.x - from.x) * dy - (at.y - from.y) * dx);
      if (!(away <= kStraight * (dx * dx + dy * dy))) return false;
    }
    from = to;
  }
  return true;
}

// The number of pieces of a segment; 1 if it is straight enough.
std::size_t pieces_of(const Projecting& projecting, Point a, Point b) {
  // A turn by this many degrees bends a segment by less than kStraight of its length.
  constexpr double kShort = 0.3;
  if (turn_of_segment(a, b) < kShort) return 1;
  std::size_t pieces = 1;
  while (pieces < kMaxPieces && !are_straight(projecting, a, b, pieces)) pieces *= 2;
  return pieces;
}

// Divides segments where points lie on them, and those that are not straight in the plane.
class Divider {
 public:
  // `lonlat` are the points of the domain, whose `snap` is set.
  Divider(Domain& domain, std::vector<Point>& lonlat, const LonLatExtent& extent,
          const Projecting& projecting)
      : domain_(domain),
        lonlat_(lonlat),
        projecting_(projecting),
        touches_(lonlat, extent, domain.snap) {}

  Result<void> divide() {
    const std::size_t segments = domain_.segments.size();
    for (std::size_t i = 0; i < segments; ++i) {
      const Domain::Segment whole = domain_.segments[i];
      std::vector<std::uint32_t> stops = touches_.on(whole.a, whole.b);
      if (touches_.looked_at() > kMaxPairs)
        return too_many(i, "points near segments that more than " + with_separators(kMaxPairs) +
                               " pairs of them would be looked at");
      divided_ += stops.size();
      if (divided_ > kMaxAdded)
        return too_many(i, "points on segments that these would be divided more than " +
                               with_separators(kMaxAdded) + " times");
      stops.push_back(whole.b);
      std::vector<std::uint32_t> chain{whole.a};
      for (const std::uint32_t stop : stops)
        if (auto ok = go_on(i, stop, chain); !ok) return ok;
      for (std::size_t part = 1; part < chain.size(); ++part) {
        const Domain::Segment piece{chain[part - 1], chain[part], whole.marker, whole.area};
        if (part == 1) {
          domain_.segments[i] = piece;
        } else {
          domain_.segment_places.add_same(domain_.segments.size(), domain_.segment_places, i);
          domain_.segments.push_back(piece);
        }
      }
    }
    if (!domain_.point_markers.empty()) domain_.point_markers.resize(lonlat_.size());
    return {};
  }

 private:
  tl::unexpected<Error> too_many(std::size_t segment, const std::string& of_what) const {
    return fail(ExitCode::kUnreadableInput,
                domain_.segment_places.locate(segment) + ": the domain has so many " + of_what);
  }

  // Adds to the chain, which is part of segment i, the points up to this one.
  Result<void> go_on(std::size_t i, std::uint32_t stop, std::vector<std::uint32_t>& chain) {
    Point a = lonlat_[chain.back()];
    Point b = lonlat_[stop];
    const std::size_t pieces = pieces_of(projecting_, a, b);
    added_ += pieces - 1;
    if (added_ > kMaxAdded)
      return too_many(i, "long segments that more than " + with_separators(kMaxAdded) +
                             " points would have to be added on them");
    // Two segments between the same points get the same points, whatever their directions.
    const bool turned = std::pair(b.x, b.y) < std::pair(a.x, a.y);
    if (turned) std::swap(a, b);
    for (std::size_t piece = 1; piece < pieces; ++piece) {
      const std::size_t step = turned ? pieces - piece : piece;
      const auto point = static_cast<std::uint32_t>(lonlat_.size());
      domain_.point_places.add_same(point, domain_.segment_places, i);
      lonlat_.push_back(on_segment(a, b, static_cast<double>(step) / static_cast<double>(pieces)));
      chain.push_back(point);
    }
    chain.push_back(stop);
    return {};
  }

  Domain& domain_;
  std::vector<Point>& lonlat_;
  const Projecting& projecting_;
  SegmentTouches touches_;
  std::size_t added_ = 0;
  std::size_t divided_ = 0;
};

Projection::Distortion distortion_over(const Projection& projection,
                                       const std::vector<Point>& lonlat, Point centre) {
  Projection::Distortion all = projection.distortion_at(centre);
  const std::size_t stride = 1 + (lonlat.size() - 1) / kMaxSamples;
  for (std::size_t i = 0; i < lonlat.size(); i += stride) {
    const auto here = projection.distortion_at(lonlat[i]);
    all.least_scale = std::fmin(all.least_scale, here.least_scale);
    all.greatest_scale = std::fmax(all.greatest_scale, here.greatest_scale);
    all.angle_deg = std::fmax(all.angle_deg, here.angle_deg);
  }
  return all;
}

Result<Projection> projection_for(const Domain& domain, const LonLatExtent& extent,
                                  const std::string& crs) {
  if (!crs.empty()) return Projection::make(crs);
  const auto suitable = suitable_projection(domain, extent);
  if (!suitable) return tl::unexpected(suitable.error());
  return Projection::make(*suitable);
}

}  // namespace

Result<DomainProjection> DomainProjection::project(Domain& domain, const ProjectionOptions& options,
                                                   double snap) {
  if (!Projection::available())
    return fail(ExitCode::kUsage,
                "this weft was built without PROJ, which projects longitude and latitude");
  if (domain.arcs.size() > kMaxArcs)
    return fail(ExitCode::kUnreadableInput,
                "the domain has " + with_separators(domain.arcs.size()) + " arcs, of which " +
                    with_separators(kMaxArcs) + " are projected at most");
  // What is a circle in degrees is none in the plane.
  if (auto flat = flatten_arcs(domain); !flat) return tl::unexpected(flat.error());
  const auto extent = lonlat_extent(domain);
  if (!extent) return tl::unexpected(extent.error());
  auto projection = projection_for(domain, *extent, options.crs);
  if (!projection) return tl::unexpected(projection.error());
  DomainProjection made(std::move(*projection));
  made.to_metres_ = options.to_metres;
  made.jumps_ = extent->jumps;
  const auto [west, east] =
      std::minmax_element(domain.points.begin(), domain.points.end(),
                          [](const Point& a, const Point& b) { return a.x < b.x; });
  made.middle_ = (west->x + east->x) / 2;
  made.lonlat_ = std::move(domain.points);
  made.distortion_ = distortion_over(made.projection_, made.lonlat_, extent->centre);

  domain.snap = snap > 0 && std::isfinite(snap) ? snap : kProjectedSnap;
  const Projecting projecting(made.projection_, *extent);
  const std::size_t in_file = made.lonlat_.size();
  if (auto ok = Divider(domain, made.lonlat_, *extent, projecting).divide(); !ok)
    return tl::unexpected(ok.error());
  for (std::size_t i = in_file; i < made.lonlat_.size(); ++i)
    made.lonlat_[i] = made.as_in_file(made.lonlat_[i]);
  domain.points.clear();
  domain.points.reserve(made.lonlat_.size());
  for (std::size_t i = 0; i < made.lonlat_.size(); ++i) {
    const auto at = projecting.checked(made.lonlat_[i], domain.point_places, i);
    if (!at) return tl::unexpected(at.error());
    domain.points.push_back(*at);
  }
  made.metres_ = domain.points;
  for (std::size_t i = 0; i < domain.holes.size(); ++i) {
    const auto at = projecting.checked(domain.holes[i], domain.hole_places, i);
    if (!at) return tl::unexpected(at.error());
    domain.holes[i] = *at;
  }
  for (std::size_t i = 0; i < domain.regions.size(); ++i) {
    const auto at = projecting.checked(domain.regions[i].at, domain.region_places, i);
    if (!at) return tl::unexpected(at.error());
    domain.regions[i].at = *at;
  }
  return made;
}

Result<void> check_lonlat(const std::filesystem::path& path, const Domain& domain) {
  if (const auto& system = domain.system; system && !system->geographic)
    return fail(ExitCode::kUnreadableInput,
                path.string() + ": its coordinate system, " + in_quotes(system->name) +
                    ", is a plane: leave out --lonlat, --crs and --to-metres, or bring it into "
                    "longitude and latitude with ogr2ogr -t_srs EPSG:4326");
  const auto extent = lonlat_extent(domain);
  if (extent) return {};
  const std::string& message = extent.error().message;
  const std::string file = path.string() + ": ";
  return fail(extent.error().exit, (message.starts_with(file) ? "" : file) + message);
}

void warn_of_degrees(const std::filesystem::path& path, Domain& domain) {
  if (!domain.system || !domain.system->geographic) return;
  domain.warnings.push_back(
      {.kind = WarningKind::kCoordinates,
       .file = path.string(),
       .text = "its coordinates are longitudes and latitudes (" + domain.system->name +
               "): lengths, areas and angles are those of degrees; --lonlat has them on the "
               "ground"});
}

Result<std::shared_ptr<const DomainProjection>> DomainProjection::project_file(
    const std::filesystem::path& path, Domain& domain, const ProjectionOptions& options,
    double snap) {
  if (!options.wanted()) {
    warn_of_degrees(path, domain);
    return nullptr;
  }
  if (auto ok = check_lonlat(path, domain); !ok) return tl::unexpected(ok.error());
  auto projection = project(domain, options, snap);
  if (!projection)
    return fail(projection.error().exit, path.string() + ": " + projection.error().message);
  return std::make_shared<const DomainProjection>(std::move(*projection));
}

std::vector<std::string> DomainProjection::warnings() const {
  std::vector<std::string> all;
  char text[128];
  if (distortion_.angle_deg > 0.01) {
    std::snprintf(text, sizeof text, "is not conformal: angles on the ground differ by up to %.2f",
                  distortion_.angle_deg);
    all.push_back(in_quotes(name()) + " " + text + " degrees from those in the plane");
  }
  if (distortion_.least_scale < 0.95 || distortion_.greatest_scale > 1.05) {
    std::snprintf(text, sizeof text, "lengths in the plane are %.3f to %.3f of those on the ground",
                  distortion_.least_scale, distortion_.greatest_scale);
    all.push_back(std::string(text) + ", and so are edges where a size asks for them");
  }
  if (jumps_ && !to_metres_)
    all.push_back(
        "longitudes jump by 360 degrees at the date line, as they do in the domain, and so do "
        "triangles there; --to-metres writes the mesh without a jump");
  return all;
}

Point DomainProjection::to_plane(Point lonlat) const {
  return on_grid(projection_.forward(lonlat));
}

Point DomainProjection::to_lonlat(Point metres) const {
  return as_in_file(projection_.inverse(metres));
}

Point DomainProjection::named_place(Point metres) const {
  return rounded(to_lonlat(metres), 1e7);
}

Point DomainProjection::as_in_file(Point lonlat) const {
  if (lonlat.x <= middle_ - 180) lonlat.x += 360;
  if (lonlat.x > middle_ + 180) lonlat.x -= 360;
  return lonlat;
}

Result<ScratchArray<double>> DomainProjection::to_lonlat(const MeshView& mesh) const {
  ScratchArray<double> lonlat(mesh.pages, mesh.coordinates.size());
  for (const std::size_t i : mesh.up_to(mesh.vertex_count())) {
    const Point metres{mesh.coordinates[2 * i], mesh.coordinates[2 * i + 1]};
    const Point at = to_lonlat(metres);
    if (!std::isfinite(at.x) || !std::isfinite(at.y))
      return fail(ExitCode::kInternal, in_quotes(name()) + " cannot bring the vertex at " +
                                           coordinates(metres.x, metres.y) + " back");
    lonlat[2 * i] = at.x;
    lonlat[2 * i + 1] = at.y;
  }
  Jumps jumps(mesh.pages);
  for (const std::size_t i : mesh.up_to(mesh.input_points.size() / 2)) {
    const std::size_t vertex = mesh.input_points[2 * i];
    const std::size_t point = mesh.input_points[2 * i + 1];
    jumps.to(2 * vertex);
    if (point >= metres_.size() ||
        metres_[point] != Point{mesh.coordinates[2 * vertex], mesh.coordinates[2 * vertex + 1]})
      continue;
    lonlat[2 * vertex] = lonlat_[point].x;
    lonlat[2 * vertex + 1] = lonlat_[point].y;
  }
  return lonlat;
}

}  // namespace weft::files
