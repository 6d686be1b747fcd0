// SPDX-License-Identifier: Apache-2.0
// A domain as a file describes it: a planar straight-line graph with seeds, and the place of each
// part in the file. Indices count from 0, whatever the file counts from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "files/base/error.h"
#include "files/formats/domains/region_values.h"
#include "files/formats/names.h"
#include "files/formats/warning.h"

namespace weft::files {

struct Point {
  double x = 0;
  double y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

// The places of a list's elements in a file, run-length coded: element i of a run that starts at
// `first` is at prefix + (number + i - first) + suffix, as in "coast.poly:" 17 "" or
// "coast.geojson: features[3].geometry.coordinates[0][" 17 "]".
class Provenance {
 public:
  // REQUIRES: `first` does not decrease from call to call.
  void add(std::size_t first, std::string prefix, std::uint64_t number, std::string suffix);
  // As `add`, unless the last run already continues through (first, number).
  void extend(std::size_t first, const std::string& prefix, std::uint64_t number);
  // The element `first` has the place of element i of `other`, which may be this list. REQUIRES: as
  // for `add`, and the next element is added, too.
  void add_same(std::size_t first, const Provenance& other, std::size_t i);
  // Empty if the element's place is not known.
  std::string locate(std::size_t i) const;
  // Of memory.
  std::size_t bytes() const;

 private:
  struct Run {
    std::size_t first = 0;
    std::string prefix;
    std::uint64_t number = 0;
    std::string suffix;
  };
  // The run that holds element i; null if there is none.
  const Run* run_of(std::size_t i) const;

  std::vector<Run> runs_;
};

// Longitude and latitude of WGS 84, as GDAL calls it.
inline constexpr const char* kLonLat = "OGC:CRS84";

// Of the coordinates in a file.
struct CoordinateSystem {
  std::string name;         // for messages: "WGS 84 / UTM zone 18N"
  bool geographic = false;  // longitudes and latitudes, not a plane
  std::string definition;   // as WKT, of OGC or of Esri; or kLonLat
  friend bool operator==(const CoordinateSystem&, const CoordinateSystem&) = default;
};

struct Domain {
  struct Segment {
    std::uint32_t a = 0;  // index into points
    std::uint32_t b = 0;
    std::int32_t marker = 0;
    std::uint32_t area = 0;  // 1 + index into areas if it is part of the border of one
    friend bool operator==(const Segment&, const Segment&) = default;
  };
  // Makes a segment an arc of a circle; see arc_bulges in the protocol.
  struct Arc {
    static constexpr double kMaxBulge = 1e6;  // that the service takes
    std::uint32_t segment = 0;
    double bulge = 0;
    friend bool operator==(const Arc&, const Arc&) = default;
  };
  // A polygon: what an odd number of its rings encloses.
  struct Area {
    std::optional<std::int32_t>
        region;  // of the triangles in it; of the smallest area if several overlap
    std::optional<double> max_area;  // > 0
    bool is_hole = false;            // carves what it covers away
    friend bool operator==(const Area&, const Area&) = default;
  };
  struct Region {
    Point at;
    std::int32_t id = 0;
    std::optional<double> max_area;  // > 0
    friend bool operator==(const Region&, const Region&) = default;
  };
  // Which faces are meshed: all bounded ones less the holes; those inside an odd number of rings,
  // or of areas if there are any; those that an area covers.
  enum class Fill { kSeeds, kEvenOdd, kUnion };

  std::vector<Point> points;
  std::vector<std::int32_t> point_markers;  // one per point, or empty: all 0
  std::vector<Segment> segments;
  std::vector<Arc> arcs;  // in the order of their segments, each once
  std::vector<Point> holes;
  std::vector<Region> regions;
  std::vector<Area> areas;
  std::vector<RegionValue> region_values;  // of ids that stand for another number in the file
  Fill fill = Fill::kSeeds;
  double snap = 0;  // features nearer together are one, unless a request says another distance
  std::optional<CoordinateSystem> system;  // if the file names one
  Names names;                             // of markers and regions, of the domain's own or not
  std::vector<Warning> warnings;           // about the file

  Provenance point_places;
  Provenance segment_places;
  Provenance hole_places;
  Provenance region_places;
  Provenance area_places;
};

// The corners between `a` and `b` if the arc of that bulge becomes equal chords that turn by 2
// degrees at most. None of a bulge of 0.
std::vector<Point> chord_corners(Point a, Point b, double bulge);

// Replaces each arc by these chords: for what knows no arcs. Error (kUnreadableInput), and nothing
// is replaced: over 4,000,000 of them.
Result<void> flatten_arcs(Domain& domain);

// What is meshed where polygons overlap: all that any of them covers; what an odd number of them
// covers; the first less the others.
enum class PolygonFill { kUnion, kEvenOdd, kDifference };

// Without areas, even-odd filling is by the parity of segments.
void fill_polygons(Domain& domain, PolygonFill fill);

}  // namespace weft::files
