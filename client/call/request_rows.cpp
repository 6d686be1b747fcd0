// SPDX-License-Identifier: Apache-2.0
#include "client/call/request_rows.h"

#include <utility>

#include "client/formats/raster.h"

namespace weft::client {
namespace {

using Request = RequestOptions;

// A text that the server reads, or the path of a grid.
OptionValue<Request> size(std::string Request::*field) {
  return {"EXPR|FILE", "", Arity::kOne,
          [field](const auto& texts, const auto& folder, Request& options) -> std::string {
            options.*field =
                is_raster_path(texts.front()) ? (folder / texts.front()).string() : texts.front();
            return "";
          }};
}

OptionValue<Request> fields() {
  return {"NAME=KIND", "", Arity::kList,
          [](const auto& texts, const auto& folder, Request& options) -> std::string {
            std::vector<FieldOption> fields;
            for (const std::string& text : texts) {
              auto field = FieldOption::parse(text, folder);
              if (!field) return field.error();
              fields.push_back(std::move(*field));
            }
            options.fields = std::move(fields);
            return "";
          }};
}

OptionValue<Request> edge_at() {
  return {"marker=M:LEN", "", Arity::kList,
          [](const auto& texts, const auto&, Request& options) -> std::string {
            std::vector<EdgeAt> all;
            for (const std::string& text : texts) {
              const auto one = EdgeAt::parse(text);
              if (!one) return one.error();
              all.push_back(*one);
            }
            options.edge_at = std::move(all);
            return "";
          }};
}

const OptionRows<Request>& other_rows() {
  static const OptionRows<Request> rows = {
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

}  // namespace

const OptionRows<Request>& size_rows() {
  static const OptionRows<Request> rows = {
      {"size", "",
       "Maximum area of a triangle, taken at its centroid: a number, an expression in x, y and "
       "the names of fields, or a grid of areas in an .asc file (ESRI ASCII)",
       "no bound", size(&Request::size)},
      {"edge", "",
       "Length of edges, instead of --size: triangles are at most as large as the equilateral one "
       "with this edge at their centroid. A number, an expression or a grid of lengths, as --size",
       "no bound", size(&Request::edge)},
      {"field", "",
       "A field that --edge or --size may name. KIND is distance, to all segments; "
       "distance:marker=2,3, to those with a marker; distance:FILE, to the points and lines of a "
       "domain file; width, the domain's local width; mesh:FILE[:ARRAY], values at the vertices of "
       "an earlier mesh; or FILE[:BAND], the values of a raster. May be repeated",
       "", fields()},
      {"edge-at", "",
       "Maximum length LEN of edges on segments with the marker M. With --gradation, edges grow "
       "from there by it at most. May be repeated, once for each marker",
       "", edge_at()},
      {"gradation", "WEFT_GRADATION",
       "How much the length of edges may grow per unit of length; a size that grows faster is "
       "lowered. 0.15 is common",
       "no limit", number("G", &Request::gradation, 0.001, 1000)},
      {"cells-across", "WEFT_CELLS_ACROSS",
       "How many edges fit across the domain at least, about, where it is narrow: no edge is "
       "wanted "
       "longer than the local width divided by N. Best with --gradation",
       "any number", number("N", &Request::cells_across, 0.01, 1e6)},
  };
  return rows;
}

const OptionRows<Request>& request_rows() {
  static const OptionRows<Request> rows = [] {
    OptionRows<Request> all = size_rows();
    const OptionRows<Request>& others = other_rows();
    all.insert(all.end(), others.begin(), others.end());
    return all;
  }();
  return rows;
}

}  // namespace weft::client
