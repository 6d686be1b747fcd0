// SPDX-License-Identifier: Apache-2.0
#include "client/call/request_rows.h"

namespace weft::client {
namespace {

using Request = RequestOptions;

// A text that the server reads, or the path of a grid.
OptionValue<Request> size() {
  return {"EXPR|FILE", "", Arity::kOne,
          [](const auto& texts, const auto& folder, Request& options) -> std::string {
            options.size =
                is_raster_path(texts.front()) ? (folder / texts.front()).string() : texts.front();
            return "";
          }};
}

}  // namespace

const OptionRows<Request>& request_rows() {
  static const OptionRows<Request> rows = {
      {"size", "",
       "Maximum area of a triangle, taken at its centroid: a number, an expression in x and y, or "
       "a "
       "grid of areas in an .asc file (ESRI ASCII)",
       "no bound", size()},
      {"min-angle", "WEFT_MIN_ANGLE", "Minimum angle of every triangle, in degrees, 0 to 36", "20",
       number("DEG", &Request::min_angle_deg)},
      {"min-edge", "WEFT_MIN_EDGE",
       "Shortest edge that refinement may make; angle and area give way to it", "",
       number("LEN", &Request::min_edge)},
      {"placement", "WEFT_PLACEMENT",
       "Where new points go in triangles that are too large: lattice follows the size and makes a "
       "third fewer triangles, circumcentre makes a mesh without any direction",
       "lattice",
       one_of(&Request::placement,
              {{"lattice", v1::PLACEMENT_LATTICE}, {"circumcentre", v1::PLACEMENT_CIRCUMCENTRE}})},
      {"optimise", "WEFT_OPTIMISE",
       "Sweeps of smoothing, 0 to 16: vertices around angles below 48 degrees move to where the "
       "smallest angle around them is largest",
       "2 if the size makes nearly all triangles, on a lattice with few faults or in a mesh below "
       "100,000 triangles; otherwise 0",
       number("N", &Request::optimise)},
      {"snap", "WEFT_SNAP",
       "First merge points and segments of the domain that are nearer together than this",
       "only what double precision cannot keep apart", number("D", &Request::snap)},
      {"allow-unrefined", "WEFT_ALLOW_UNREFINED",
       "Accept a mesh with triangles that miss a bound although neither the domain nor a flag "
       "forces them to",
       "such a mesh is an error", on_or_off(&Request::allow_unrefined)},
      {"max-triangles", "WEFT_CLIENT_MAX_TRIANGLES", "Stop refining at this number of triangles",
       "", number("N", &Request::max_triangles, 1)},
      {"max-seconds", "WEFT_CLIENT_MAX_SECONDS", "Maximum time of work; then the call fails", "",
       number("S", &Request::max_seconds, 0.001, 1e9)},
      {"threads", "WEFT_CLIENT_THREADS",
       "Threads of the server that compute; the mesh does not depend on them", "all",
       number("N", &Request::threads, 1)},
      {"no-cache", "WEFT_NO_CACHE", "Make the mesh again, even if the server has it", "",
       on_or_off(&Request::no_cache)},
  };
  return rows;
}

}  // namespace weft::client
