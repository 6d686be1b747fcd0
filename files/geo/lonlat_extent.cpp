// SPDX-License-Identifier: Apache-2.0
#include "files/geo/lonlat_extent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "files/base/text.h"

namespace weft::files {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

tl::unexpected<Error> refuse(const Provenance& places, std::size_t i, const char* what,
                             const std::string& why) {
  std::string place = places.locate(i);
  if (place.empty()) place = std::string(what) + " " + std::to_string(i);
  return fail(ExitCode::kUnreadableInput, place + ": " + why);
}

Result<void> check_point(const Provenance& places, std::size_t i, const char* what, Point at) {
  if (!(std::abs(at.y) <= 90))
    return refuse(places, i, what,
                  "the latitude " + shortest(at.y) + " is not between -90 and 90 degrees");
  if (!(std::abs(at.x) <= 360))
    return refuse(places, i, what,
                  "the longitude " + shortest(at.x) + " is not between -360 and 360 degrees");
  return {};
}

Result<void> check_domain(const Domain& domain) {
  if (domain.points.empty()) return fail(ExitCode::kUnreadableInput, "the domain has no points");
  for (std::size_t i = 0; i < domain.points.size(); ++i)
    if (auto ok = check_point(domain.point_places, i, "point", domain.points[i]); !ok) return ok;
  for (std::size_t i = 0; i < domain.holes.size(); ++i)
    if (auto ok = check_point(domain.hole_places, i, "hole", domain.holes[i]); !ok) return ok;
  for (std::size_t i = 0; i < domain.regions.size(); ++i)
    if (auto ok = check_point(domain.region_places, i, "region", domain.regions[i].at); !ok)
      return ok;
  for (std::size_t i = 0; i < domain.segments.size(); ++i) {
    const auto& [a, b, marker, area] = domain.segments[i];
    const bool is_at_pole =
        std::abs(domain.points[a].y) == 90 && domain.points[a].y == domain.points[b].y;
    if (!is_at_pole && std::abs(domain.points[b].x - domain.points[a].x) >= 360)
      return refuse(domain.segment_places, i, "segment",
                    "the segment goes all around the Earth: divide it, or cut the domain");
  }
  return {};
}

// Brings a longitude to [-180, 180); one that lies there stays as it is. REQUIRES: -720 to 720.
double wrapped(double longitude) {
  while (longitude < -180) longitude += 360;
  while (longitude >= 180) longitude -= 360;
  return longitude;
}

struct Arc {
  double west;  // -180 to 180
  double width;
};

// Cuts the circle of longitudes in the widest gap between the arcs.
void find_range(std::vector<Arc>& arcs, LonLatExtent& extent) {
  std::sort(arcs.begin(), arcs.end(), [](const Arc& a, const Arc& b) { return a.west < b.west; });
  double reached = arcs.front().west;  // by the arcs up to here
  for (const Arc& arc : arcs) reached = std::max(reached, arc.west + arc.width);
  reached -= 360;  // by the arcs that go on beyond 180, from -180 on
  double widest = 0;
  extent.west = -180;
  for (const Arc& arc : arcs) {
    if (arc.west - reached > widest) {
      widest = arc.west - reached;
      extent.west = arc.west;
    }
    reached = std::max(reached, arc.west + arc.width);
  }
  extent.around = widest <= 0;
  extent.width = 360 - widest;
}

// At most so many points stand for all of them, because each is read several times.
constexpr std::size_t kMaxPoints = 10'000;

struct Candidate {
  std::string parameters;
  // The logarithm of the scale on the sphere, at a longitude relative to the central one, and a
  // latitude, in radians.
  std::function<double(double, double)> log_scale;
  double central;  // longitude, in degrees
};

std::string degrees(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5f", value);
  std::string digits = text;
  digits.erase(digits.find_last_not_of('0') + 1);
  if (digits.back() == '.') digits.pop_back();
  return digits == "-0" ? "0" : digits;
}

// The value with as many digits as the parameter's text has.
double rounded(double value) {
  return std::round(value * 1e5) / 1e5;
}

std::vector<Candidate> candidates(const LonLatExtent& extent) {
  const double lon = rounded(wrapped(extent.west + extent.width / 2));
  const double lat = rounded((extent.south + extent.north) / 2);
  const double middle = extent.around ? rounded(extent.centre.x) : lon;
  std::vector<Candidate> all;
  all.push_back({"+proj=tmerc +lat_0=" + degrees(lat) + " +lon_0=" + degrees(middle),
                 [](double dl, double phi) {
                   const double b = std::cos(phi) * std::sin(dl);
                   if (std::cos(dl) < 0 && std::cos(phi) > 0.5) return HUGE_VAL;  // outside the map
                   return -std::log1p(-b * b) / 2;
                 },
                 middle});
  if (!extent.around) {
    if (std::abs(lat) >= 1 && std::abs(lat) <= 85) {
      const double phi0 = lat * kRadiansPerDegree;
      const auto unit = [n = std::sin(phi0)](double phi) {
        return -n * std::asinh(std::tan(phi)) - std::log(std::cos(phi));
      };
      all.push_back({"+proj=lcc +lat_1=" + degrees(lat) + " +lat_0=" + degrees(lat) +
                         " +lon_0=" + degrees(lon),
                     [unit, at0 = unit(phi0)](double, double phi) { return unit(phi) - at0; },
                     lon});
    }
    all.push_back({"+proj=merc +lon_0=" + degrees(lon),
                   [](double, double phi) { return -std::log(std::cos(phi)); }, lon});
  }
  const double clat = rounded(extent.centre.y);
  const double clon = std::abs(clat) == 90 ? 0 : rounded(extent.centre.x);
  const double phi0 = clat * kRadiansPerDegree;
  all.push_back({"+proj=stere +lat_0=" + degrees(clat) + " +lon_0=" + degrees(clon),
                 [sin0 = std::sin(phi0), cos0 = std::cos(phi0)](double dl, double phi) {
                   const double c = sin0 * std::sin(phi) + cos0 * std::cos(phi) * std::cos(dl);
                   return -std::log((1 + c) / 2);
                 },
                 clon});
  return all;
}

// The middle of the box in space around the points on the unit sphere, as seen from the middle of
// the sphere.
Point centre_of(const Domain& domain) {
  std::array<double, 3> least{2, 2, 2};
  std::array<double, 3> most{-2, -2, -2};
  for (const Point& at : domain.points) {
    const double lon = at.x * kRadiansPerDegree;
    const double lat = at.y * kRadiansPerDegree;
    const std::array<double, 3> v{std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon),
                                  std::sin(lat)};
    for (int k = 0; k < 3; ++k) {
      least[k] = std::min(least[k], v[k]);
      most[k] = std::max(most[k], v[k]);
    }
  }
  const double x = (least[0] + most[0]) / 2;
  const double y = (least[1] + most[1]) / 2;
  const double z = (least[2] + most[2]) / 2;
  const double flat = std::sqrt(x * x + y * y);
  const double lat = std::atan2(z, flat) / kRadiansPerDegree;
  if (std::abs(lat) > 89.99) return {0, lat < 0 ? -90.0 : 90.0};
  return {std::atan2(y, x) / kRadiansPerDegree, lat};
}

}  // namespace

double LonLatExtent::unwrapped(double longitude) const {
  while (longitude < west) longitude += 360;
  while (longitude >= west + 360) longitude -= 360;
  return longitude;
}

double longitude_scale(double latitude_deg) {
  return std::max(0.01, std::cos(latitude_deg * kRadiansPerDegree));
}

double longitude_step(double from, double to) {
  double step = to - from;
  while (step > 180) step -= 360;
  while (step < -180) step += 360;
  return step;
}

double distance_deg(Point a, Point b) {
  const double x = longitude_step(a.x, b.x) * std::cos(a.y * kRadiansPerDegree);
  const double y = b.y - a.y;
  return std::sqrt(x * x + y * y);
}

double turn_of_segment(Point a, Point b) {
  const double steep = std::tan(std::max(std::abs(a.y), std::abs(b.y)) * kRadiansPerDegree);
  return std::abs(longitude_step(a.x, b.x)) + std::abs(b.y - a.y) * std::max(1.0, steep);
}

Result<LonLatExtent> lonlat_extent(const Domain& domain) {
  if (auto ok = check_domain(domain); !ok) return tl::unexpected(ok.error());
  LonLatExtent extent;
  extent.south = extent.north = domain.points.front().y;
  std::vector<Arc> arcs;
  arcs.reserve(domain.points.size() + domain.segments.size());
  for (const Point& at : domain.points) {
    arcs.push_back({wrapped(at.x), 0});
    extent.south = std::min(extent.south, at.y);
    extent.north = std::max(extent.north, at.y);
  }
  for (const auto& [a, b, marker, area] : domain.segments) {
    const double from = domain.points[a].x;
    const double to = domain.points[b].x;
    const double step = longitude_step(from, to);
    arcs.push_back({wrapped(step < 0 ? to : from), std::abs(step)});
    if (std::abs(to - from) > 180) extent.jumps = true;
  }
  find_range(arcs, extent);
  extent.centre = centre_of(domain);
  return extent;
}

Result<std::string> suitable_projection(const Domain& domain, const LonLatExtent& extent) {
  const std::size_t stride = 1 + (domain.points.size() - 1) / kMaxPoints;
  double best = std::numeric_limits<double>::infinity();
  std::string parameters;
  for (const Candidate& candidate : candidates(extent)) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    const auto add = [&](Point at) {
      const double scale = candidate.log_scale(
          wrapped(at.x - candidate.central) * kRadiansPerDegree, at.y * kRadiansPerDegree);
      least = std::min(least, scale);
      most = std::max(most, scale);
    };
    for (std::size_t i = 0; i < domain.points.size(); i += stride) add(domain.points[i]);
    add(extent.centre);
    if (!(most - least < best)) continue;
    best = most - least;
    char factor[32];
    std::snprintf(factor, sizeof factor, " +k_0=%.6g", std::exp(-(least + most) / 2));
    parameters = candidate.parameters + factor + " +datum=WGS84";
  }
  if (!(best <= std::log(10.0)))
    return fail(ExitCode::kUnreadableInput,
                "the domain covers so much of the Earth that the scale of every conformal "
                "projection varies more than tenfold over it: cut the domain");
  return parameters;
}

}  // namespace weft::files
