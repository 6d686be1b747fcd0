// SPDX-License-Identifier: Apache-2.0
// Makes a domain of points, lines and polygons, as GeoJSON, WKT and shapefiles have them.
//
// What is meshed:
//   - With polygons: what any of them covers (Fill::kUnion). Each is an area of its own: the points
//   inside
//     an odd number of its rings. So rings of holes are holes, and polygons may overlap, nest and
//     touch.
//   - Lines beside polygons become edges inside the domain.
//   - Lines only: every bounded face (Fill::kSeeds).
//   - Points become vertices.
// Segments may be arcs; whether rings cross and overlap is told of their chords (chord_corners).
// Positions that repeat their predecessor are dropped.
//
// `path` names a part in its file ("features[3].geometry.coordinates[0]"); its position i is then
// path[i]. Errors (kUnreadableInput) name the file and the path: magnitudes beyond 1e50. A ring
// that does not end where it starts is closed, with a warning. A ring that crosses itself or
// another of its polygon is a warning, as is one whose role is not what parity makes of it
// (ring_crossing.h): parity decides what is inside. Rings without an area (fewer than 3 distinct
// points), with the holes of such a ring, and lines without a length are left out, which one
// warning tells of (left_out.h).
//
//   GeometryBuilder builder("coast.wkt");
//   builder.begin_polygon();
//   if (auto added = builder.ring(positions, "polygon 1, ring 0", {}); !added) ...
//   builder.end_polygon("polygon 1", {.region = 7});
//   Result<Domain> domain = builder.finish();
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/formats/domains/left_out.h"
#include "files/formats/domains/ring_crossing.h"
#include "files/formats/names.h"
#include "files/formats/warning.h"

namespace weft::files {

// The properties of a geometry in a file.
// A name beside a number that is not 0 is that of the number. A name alone stands for a number that
// the file does not use, the same wherever the name appears.
struct GeometryProperties {
  std::int32_t marker = 0;             // of its segments
  std::optional<std::int32_t> region;  // of the triangles inside its polygons
  std::optional<double> max_area;      // of these triangles, positive
  std::optional<double> max_edge;      // of these triangles' edges, positive
  std::string marker_name{};
  std::string region_name{};
};

class GeometryBuilder {
 public:
  // `lonlat`: positions are longitudes and latitudes in degrees, and rings are judged on the
  // sphere, where they may go across the date line and around a pole. A ring that comes round to
  // its own meridian, from -180 to 180 or from 0 to 360, is closed there.
  explicit GeometryBuilder(std::string file, bool lonlat = false)
      : file_(std::move(file)), names_(file_), lonlat_(lonlat) {}

  // A label for a marker, to be given to `line` and `ring`.
  std::uint32_t marker(std::int32_t number) { return markers_.of(number); }
  std::uint32_t marker(std::string_view name) { return markers_.of(name); }

  Result<void> point(Point at, const std::string& path);
  // `markers`: a label for each position, of the segment that starts there; or empty: the marker of
  // the properties. `bulges`: of each of these segments, 0 if it is straight (Domain::Arc); or
  // empty: all are.
  Result<void> line(std::span<const Point> positions, const std::string& path,
                    const GeometryProperties& properties,
                    std::span<const std::uint32_t> markers = {},
                    std::span<const double> bulges = {});

  // Tells of something that a reader leaves out.
  void leave_out(LeftOut::Kind kind, const std::string& path) { left_out_.add(kind, path); }
  // The same of a property at `path`, with what it is: "true, not a text".
  void leave_out_property(const std::string& path, const std::string& what);
  // Of this file.
  void warn(Warning warning);

  // A polygon is the rings between these two calls.
  void begin_polygon(RingRoles roles = RingRoles::kOuterFirst);
  // `markers`, `bulges`: as of a line, the last of them of the segment that closes the ring.
  // `is_closed`: whether the last position repeats the first in the file's format; where it does
  // not, a warning tells of it.
  Result<void> ring(std::span<const Point> positions, const std::string& path,
                    const GeometryProperties& properties,
                    std::span<const std::uint32_t> markers = {},
                    std::span<const double> bulges = {}, bool is_closed = true);
  void end_polygon(const std::string& path, const GeometryProperties& properties);

  // Returns an error if nothing was added. The builder must not be used afterwards.
  Result<Domain> finish();

  // "coast.wkt: polygon 1 is ...".
  tl::unexpected<Error> bad(const std::string& path, const std::string& what) const;

 private:
  // Positions without repetitions: each with its number in the file, and its marker.
  struct Chain {
    std::vector<Point> points;
    std::vector<std::size_t> numbers;
    std::vector<std::uint32_t> markers;  // labels
    std::vector<double> bulges;

    // Of a ring: the corners of the chords behind its position i, if an arc begins there.
    std::vector<Point> corners_after(std::size_t i) const;
    // All corners of a ring, whose arcs are chords; empty if it has none.
    std::vector<Point> chords() const;
  };

  // A ring of the polygon, in the points of the domain.
  struct Ring {
    std::size_t first_point = 0;
    std::size_t size = 0;
    std::string path;
    std::vector<Point> chords{};  // its corners with arcs as chords, if it has arcs
  };

  Result<Chain> chain(std::span<const Point> positions, const std::string& path,
                      const GeometryProperties& properties, std::span<const std::uint32_t> markers,
                      std::span<const double> bulges = {});
  static bool is_usable(Point at);
  tl::unexpected<Error> unusable(Point at, const std::string& path) const;
  std::uint32_t label_of(Labels& labels, NameKind kind, std::int32_t number,
                         const std::string& name);
  // The sixth and further ones of a kind, if there are: "3 more rings are not closed".
  void warn_of_more(WarningKind kind, std::size_t all, const char* what);
  // `corners`: those of the ring, arcs are chords.
  void check_crossing(const Chain& ring, std::span<const Point> corners, const std::string& path);
  void check_overlap();  // of the rings of the polygon
  Result<void> add(const Chain& chain, bool closed, const std::string& path);

  std::string file_;
  NameReader names_;
  bool lonlat_;
  Labels markers_;
  Labels regions_;
  LeftOut left_out_;
  std::size_t open_rings_ = 0;
  std::size_t crossings_ = 0;  // rings that cross themselves
  std::size_t overlaps_ = 0;   // polygons of rings that overlap
  std::string ruled_line_{};   // the first line with a region, or a bound on triangles
  std::size_t odd_properties_ = 0;
  Domain domain_;  // the markers of its segments and the regions of its areas are labels
  std::size_t polygon_start_ = 0;
  RingRoles ring_roles_ = RingRoles::kOuterFirst;
  std::vector<Ring> polygon_rings_;  // those that are there
  bool polygon_crosses_ = false;     // one of them crosses itself
  bool lacks_outer_ring_ = false;    // the polygon's was left out
};

}  // namespace weft::files
