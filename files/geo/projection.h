// SPDX-License-Identifier: Apache-2.0
// A map projection by PROJ: longitude and latitude in degrees to a plane in metres, x to the east
// and y to the north, and back.
//
//   auto utm = Projection::make("EPSG:32618");
//   const Point at = utm->forward({-74, 40.6});  // metres
//   const Point back = utm->inverse(at);
//
// Longitudes and latitudes are those of the datum of the projection; no datum is changed. Not
// thread-safe: `forward` and `inverse` use one context of PROJ; another thread makes its own.
#pragma once

#include <memory>
#include <string>

#include "files/base/error.h"
#include "files/formats/domain.h"

namespace weft::files {

class Projection {
 public:
  // Whether this program was built with PROJ. Without it, every `make` fails.
  static bool available();

  // `name` is what PROJ takes for a projected coordinate reference system, such as EPSG:32618, or
  // parameters such as "+proj=lcc +lat_1=35 +lat_0=35 +lon_0=-72". Errors (kUsage): PROJ does not
  // know it, it is not a projected system, its unit is not the metre; the message begins with the
  // name in quotes. kInternal: PROJ cannot be loaded.
  static Result<Projection> make(const std::string& name);

  Projection(Projection&&) noexcept;
  Projection& operator=(Projection&&) noexcept;
  ~Projection();

  const std::string& name() const;

  // Both return coordinates that are not finite if PROJ cannot project the point.
  Point forward(Point lonlat) const;
  Point inverse(Point metres) const;

  // What the projection does near a point: lengths in the plane over lengths on the ground, the
  // least and the greatest over all directions, and the most that an angle changes. All are NaN if
  // PROJ cannot project the points around. At a pole, they are those of a kilometre beside it.
  struct Distortion {
    double least_scale = 1;
    double greatest_scale = 1;
    double angle_deg = 0;
  };
  Distortion distortion_at(Point lonlat) const;

 private:
  struct Proj;
  explicit Projection(std::unique_ptr<Proj> proj);
  std::unique_ptr<Proj> proj_;
};

}  // namespace weft::files
