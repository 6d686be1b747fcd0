// SPDX-License-Identifier: Apache-2.0
// Projects a domain in longitude and latitude to a plane in metres, and brings its mesh back.
//
//   auto projection = DomainProjection::project(domain, {.lonlat = true});  // domain: in metres
//   now
//   ... the domain is meshed ...
//   auto lonlat = projection->to_lonlat(mesh);  // coordinates of the mesh's vertices, in degrees
//
// Laws: a vertex of the mesh that is a point of the domain gets the longitude and latitude of the
// file, bit for bit, unless the server merged it into another place. Longitudes of all other
// vertices are within 180 degrees of the middle of the file's longitudes: -180 to 180 if those jump
// at the date line, beyond 180 if those go on beyond.
//
// What is brought to the plane lies on a grid there (projection_options.h), so that the mesh nearly
// never depends on the last bits of the processor's sines. Degrees of new vertices, which are
// brought back, do: they lie on no grid.
//
// A segment of the file is straight in longitude and latitude, as in GeoJSON, and goes the short
// way round. In the plane it is a curve. So it is divided at the points of the domain that lie on
// it (segment_touches.h), and points are added on it until every piece is straight within a
// thousandth of its length. The added points come after those of the file, and the added segments
// after those of the file, with the places of theirs.
//
// Rounding to the grid, and the bend of a segment too short to be divided, move a point off the
// segment that it lies on. So the domain in the plane has a `snap`, which is looked for on
// segments in degrees, too.
//
// Not thread-safe.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "files/base/error.h"
#include "files/base/paged_memory.h"
#include "files/formats/domain.h"
#include "files/formats/mesh.h"
#include "files/geo/projection.h"
#include "files/geo/projection_options.h"

namespace weft::files {

// Error (kUnreadableInput): the domain, read from `path`, cannot be in longitude and latitude: its
// file says that it lies in a plane, or those of lonlat_extent.
Result<void> check_lonlat(const std::filesystem::path& path, const Domain& domain);

// Adds a warning to a domain that is not projected if its file says that it is in longitude and
// latitude.
void warn_of_degrees(const std::filesystem::path& path, Domain& domain);

class DomainProjection {
 public:
  // Projects the points, holes and regions of the domain; areas of regions stay as they are, in
  // square metres. `snap`: in metres, what is to be merged; if 0, kProjectedSnap. Errors: those of
  // Projection::make, of lonlat_extent and of suitable_projection; kUnreadableInput for a point
  // that the projection does not take there and back, for more than 1,000,000 points to add or
  // divisions at points on segments, or more than 20,000,000 pairs of a point and a segment to look
  // at. After an error, the domain is of no use.
  static Result<DomainProjection> project(Domain& domain, const ProjectionOptions& options,
                                          double snap = 0);

  // The same for a domain that was read from `path`, which errors name; null if no projection is
  // wanted, and warn_of_degrees. Errors: those of check_lonlat, too.
  static Result<std::shared_ptr<const DomainProjection>> project_file(
      const std::filesystem::path& path, Domain& domain, const ProjectionOptions& options,
      double snap);

  const std::string& name() const { return projection_.name(); }
  // Over the points of the domain, or some thousand of them if there are more, and in its middle.
  const Projection::Distortion& distortion() const { return distortion_; }
  // For people, each is one line: the projection changes angles by more than a hundredth of a
  // degree, or lengths by more than 5 %; longitudes of the mesh jump at the date line.
  std::vector<std::string> warnings() const;

  bool to_metres() const { return to_metres_; }
  Point to_lonlat(Point metres) const;
  // The same for people, to 1e-7 of a degree: to a centimetre.
  Point named_place(Point metres) const;
  // Not finite if PROJ cannot project the point.
  Point to_plane(Point lonlat) const;
  // The coordinates of all vertices, in memory of the mesh's pages. Errors (kInternal): PROJ cannot
  // bring a vertex back.
  Result<ScratchArray<double>> to_lonlat(const MeshView& mesh) const;

 private:
  explicit DomainProjection(Projection projection) : projection_(std::move(projection)) {}
  // The longitude within 180 degrees of the middle.
  Point as_in_file(Point lonlat) const;

  Projection projection_;
  Projection::Distortion distortion_;
  bool to_metres_ = false;
  bool jumps_ = false;
  double middle_ = 0;          // of the longitudes in the file
  std::vector<Point> lonlat_;  // of the domain's points
  std::vector<Point> metres_;  // the same points
};

}  // namespace weft::files
