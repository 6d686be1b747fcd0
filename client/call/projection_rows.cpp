// SPDX-License-Identifier: Apache-2.0
#include "client/call/projection_rows.h"

#include "files/geo/projection.h"

namespace weft::client {
namespace {

OptionValue<ProjectionOptions> crs() {
  return {"CODE", "", Arity::kOne,
          [](const auto& texts, const auto&, ProjectionOptions& options) -> std::string {
            if (Projection::available())
              if (const auto known = Projection::make(texts.front()); !known)
                return known.error().message;
            options.crs = texts.front();
            return "";
          }};
}

}  // namespace

const OptionRows<ProjectionOptions>& projection_rows() {
  using Options = ProjectionOptions;
  static const OptionRows<Options> rows = {
      {"lonlat", "",
       "The domain is in longitude and latitude, in degrees: it is meshed in a plane in metres, so "
       "that angles hold on the ground, and the mesh is written in longitude and latitude. Sizes "
       "are square metres, lengths metres, and x and y metres of the plane",
       "", on_or_off(&Options::lonlat)},
      {"crs", "",
       "Projection of a domain in longitude and latitude, as PROJ names it, such as EPSG:32618; "
       "implies --lonlat",
       "the conformal one whose scale varies least over the domain", crs()},
      {"to-metres", "",
       "Write the mesh of a domain in longitude and latitude in metres of the projection; implies "
       "--lonlat",
       "", on_or_off(&Options::to_metres)},
  };
  return rows;
}

}  // namespace weft::client
