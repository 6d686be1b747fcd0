// SPDX-License-Identifier: Apache-2.0
#include "files/geo/projection.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "files/base/text.h"
#include "files/geo/proj_library.h"

namespace weft::files {
namespace {

struct Destroy {
  void operator()(PJ_CONTEXT* context) const { loaded_proj().proj_context_destroy(context); }
  void operator()(PJ* pj) const { loaded_proj().proj_destroy(pj); }
};
using Context = std::unique_ptr<PJ_CONTEXT, Destroy>;
using Pj = std::unique_ptr<PJ, Destroy>;

constexpr double kRadiansPerDegree = std::numbers::pi / 180;

// What is wrong with the units of the system's axes; empty if both are metres.
std::string fault_of_unit(PJ_CONTEXT* context, const PJ* crs) {
  const Pj system(loaded_proj().proj_crs_get_coordinate_system(context, crs));
  if (!system) return "has no axes";
  for (int axis = 0; axis < 2; ++axis) {
    double factor = 0;
    const char* unit = nullptr;
    if (!loaded_proj().proj_cs_get_axis_info(context, system.get(), axis, nullptr, nullptr, nullptr,
                                             &factor, &unit, nullptr, nullptr))
      return "has no axes";
    if (factor != 1)
      return std::string("is in units of the ") + unit +
             ", but sizes and lengths are in metres: name a projection in metres";
  }
  return "";
}

}  // namespace

struct Projection::Proj {
  Context context;
  std::string name;
  Pj from_degrees;           // longitude and latitude to easting and northing
  double semi_major = 0;     // of the ellipsoid, in metres
  double eccentricity2 = 0;  // squared
};

bool Projection::available() {
  return true;
}

Result<Projection> Projection::make(const std::string& name) {
  const auto refuse = [&name](const std::string& why) {
    return fail(ExitCode::kUsage, in_quotes(name) + " " + why);
  };
  if (auto loaded = load_proj(); !loaded) return tl::unexpected(loaded.error());
  auto proj = std::make_unique<Proj>();
  proj->name = name;
  proj->context.reset(loaded_proj().proj_context_create());
  PJ_CONTEXT* const context = proj->context.get();
  loaded_proj().proj_log_level(context, PJ_LOG_NONE);
  const bool parameters = name.find("+proj") != std::string::npos;
  const bool typed = name.find("+type=crs") != std::string::npos;
  const Pj crs(loaded_proj().proj_create(
      context, (parameters && !typed ? name + " +type=crs" : name).c_str()));
  if (!crs) return refuse("is not a projection that PROJ knows");
  if (loaded_proj().proj_get_type(crs.get()) != PJ_TYPE_PROJECTED_CRS)
    return refuse("is not a projected coordinate reference system, such as EPSG:32618");
  if (const std::string fault = fault_of_unit(context, crs.get()); !fault.empty())
    return refuse(fault);
  const Pj ground(loaded_proj().proj_crs_get_geodetic_crs(context, crs.get()));
  const Pj ellipsoid(loaded_proj().proj_get_ellipsoid(context, crs.get()));
  double semi_minor = 0;
  if (!ellipsoid || !loaded_proj().proj_ellipsoid_get_parameters(
                        context, ellipsoid.get(), &proj->semi_major, &semi_minor, nullptr, nullptr))
    return refuse("has no ellipsoid");
  const double ratio = semi_minor / proj->semi_major;
  proj->eccentricity2 = 1 - ratio * ratio;
  const Pj as_named(ground ? loaded_proj().proj_create_crs_to_crs_from_pj(
                                 context, ground.get(), crs.get(), nullptr, nullptr)
                           : nullptr);
  if (as_named)
    proj->from_degrees.reset(
        loaded_proj().proj_normalize_for_visualization(context, as_named.get()));
  if (!proj->from_degrees) return refuse("is not a projection that PROJ can apply");
  return Projection(std::move(proj));
}

Projection::Projection(std::unique_ptr<Proj> proj) : proj_(std::move(proj)) {}
Projection::Projection(Projection&&) noexcept = default;
Projection& Projection::operator=(Projection&&) noexcept = default;
Projection::~Projection() = default;

const std::string& Projection::name() const {
  return proj_->name;
}

Point Projection::forward(Point lonlat) const {
  const PJ_COORD out = loaded_proj().proj_trans(
      proj_->from_degrees.get(), PJ_FWD, loaded_proj().proj_coord(lonlat.x, lonlat.y, 0, HUGE_VAL));
  return {out.xy.x, out.xy.y};
}

Point Projection::inverse(Point metres) const {
  const PJ_COORD out = loaded_proj().proj_trans(
      proj_->from_degrees.get(), PJ_INV, loaded_proj().proj_coord(metres.x, metres.y, 0, HUGE_VAL));
  return {out.xy.x, out.xy.y};
}

// By differences over about ten metres: proj_factors takes milliseconds for each system.
Projection::Distortion Projection::distortion_at(Point lonlat) const {
  constexpr double kStep = 1e-4;  // degrees
  constexpr double kNextToPole = 89.99;
  const double lat = std::clamp(lonlat.y, -kNextToPole, kNextToPole);
  const double sine = std::sin(lat * kRadiansPerDegree);
  const double w = 1 - proj_->eccentricity2 * sine * sine;
  const double per_lat = proj_->semi_major * (1 - proj_->eccentricity2) / (w * std::sqrt(w));
  const double per_lon = proj_->semi_major / std::sqrt(w) * std::cos(lat * kRadiansPerDegree);
  const Point west = forward({lonlat.x - kStep, lat});
  const Point east = forward({lonlat.x + kStep, lat});
  const Point south = forward({lonlat.x, lat - kStep});
  const Point north = forward({lonlat.x, lat + kStep});
  const double radians = 2 * kStep * kRadiansPerDegree;
  const double xe = (east.x - west.x) / (per_lon * radians);
  const double ye = (east.y - west.y) / (per_lon * radians);
  const double xn = (north.x - south.x) / (per_lat * radians);
  const double yn = (north.y - south.y) / (per_lat * radians);
  // The sum and the difference of the semi-axes of Tissot's ellipse.
  const double sum = std::hypot(xe + yn, ye - xn);
  const double difference = std::hypot(xe - yn, ye + xn);
  return {std::abs(sum - difference) / 2, (sum + difference) / 2,
          2 * std::asin(std::min(1.0, difference / sum)) / kRadiansPerDegree};
}

}  // namespace weft::files
