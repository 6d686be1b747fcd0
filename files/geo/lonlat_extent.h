// SPDX-License-Identifier: Apache-2.0
// Where on the Earth a domain in longitude and latitude lies, and which conformal projection suits
// it.
//
// Longitudes may jump by 360 degrees at the date line, or go on beyond 180: a segment goes the
// short way round, and a range of longitudes is cut in the widest gap that no segment crosses.
#pragma once

#include <string>

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

// Of latitude, on a sphere as large as the Earth.
inline constexpr double kMetresPerDegree = 111195.08;
// The length of a degree of longitude over that of a degree of latitude, at this latitude; at least
// 0.01, so that the poles are visible.
double longitude_scale(double latitude_deg);

struct LonLatExtent {
  double west = 0;   // -180 to 180; the longitudes of the domain begin here and go east
  double width = 0;  // of the longitudes, in degrees, 0 to 360
  double south = 0;
  double north = 0;
  bool around = false;  // whether segments cross all longitudes, as they do around a pole
  bool jumps = false;   // whether a segment jumps over the date line
  // Of the box around the points of the domain on the sphere: the middle of a domain around a pole
  // is there.
  Point centre;

  // The same longitude, at least `west` and less than `west` + 360.
  double unwrapped(double longitude) const;
};

// The way from one longitude to another by the short way round, -180 to 180; exactly half the way
// round goes as the numbers say.
double longitude_step(double from, double to);

// On the sphere, in degrees; exact enough for places that are close.
double distance_deg(Point a, Point b);

// By how many degrees a conformal plane turns a segment between two places, at most, or nearly so.
double turn_of_segment(Point a, Point b);

// Errors (kUnreadableInput) name the place in the file: a latitude beyond 90, a longitude beyond
// 360, a segment that goes all around the Earth, no point.
Result<LonLatExtent> lonlat_extent(const Domain& domain);

// Parameters of PROJ, on the WGS84 ellipsoid in metres, of the conformal projection whose scale
// varies least over the vertices of the domain, of these four: transverse Mercator, which suits
// tall domains, Lambert's conformal conic, which suits wide ones, Mercator, which suits wide ones
// at the equator, and the stereographic one, which suits round ones and the poles. The scale of the
// chosen one is as far above 1 somewhere as it is below 1 elsewhere. Errors (kUnreadableInput):
// the scale of the best one varies more than tenfold.
Result<std::string> suitable_projection(const Domain& domain, const LonLatExtent& extent);

}  // namespace weft::files
