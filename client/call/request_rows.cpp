// SPDX-License-Identifier: Apache-2.0
#include "client/call/request_rows.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "client/call/field_path.h"
#include "files/base/text.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/raster.h"

namespace weft::client {
namespace {

using Request = RequestOptions;

// The rows; what they read is `given` then.
OptionRows<Request> noted(OptionRows<Request> rows) {
  for (OptionRow<Request>& row : rows)
    row.value.read = [read = std::move(row.value.read), name = row.name](
                         const auto& texts, const auto& folder, Request& options) {
      std::string fault = read(texts, folder, options);
      if (fault.empty()) options.given.insert(name);
      return fault;
    };
  return rows;
}

// Whether the text, which is no grid, is the path of a file rather than an expression. No
// expression has a letter after a point, but for numbers such as "1.e5".
bool is_file(const std::string& text, const std::filesystem::path& folder) {
  const std::string extension = std::filesystem::path(text).extension().string();
  const bool is_path =
      extension.size() > 1 && std::isalpha(static_cast<unsigned char>(extension[1])) != 0;
  std::error_code ignored;
  return is_path && !value_of<double>(text) &&
         std::filesystem::is_regular_file(folder / text, ignored);
}

// Whether the text ends as the path of a file that may be a field does.
bool ends_as_a_file(const std::string& text) {
  const std::string extension = lower_extension(text);
  constexpr std::string_view kRasters[] = {".tif", ".tiff", ".img", ".bil", ".vrt"};
  return is_domain_path(text) || mesh_format(text) != nullptr ||
         std::ranges::find(kRasters, extension) != std::end(kRasters);
}

// The kind of field that the file may be. NetCDF has rasters and meshes.
std::string kind_of(const std::string& file, const std::filesystem::path& folder) {
  if (lower_extension(file) == ".nc" && !read_mesh(folder / file)) return file;
  if (check_has_vertex_values(file)) return "mesh:" + file;
  return (is_domain_path(file) ? "distance:" : "") + file;
}

// A text that the server reads, or the path of a grid.
OptionValue<Request> size(std::string Request::*field) {
  return {"EXPR|FILE", "", Arity::kOne,
          [field](const auto& texts, const auto& folder, Request& options) -> std::string {
            if (texts.front().empty())
              return "expects a number, an expression or a grid, not an empty text";
            if (!is_raster_path(texts.front()) && is_file(texts.front(), folder))
              return in_quotes(texts.front()) +
                     " is a file, not an expression: make it a field, d=" +
                     kind_of(texts.front(), folder) + ", whose name an expression can use";
            if (!is_raster_path(texts.front()) && ends_as_a_file(texts.front()))
              return in_quotes(texts.front()) + " is no expression, and there is no such file";
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

OptionValue<Request> names() {
  return {"KIND=ID:NAME", "", Arity::kList,
          [](const auto& texts, const auto&, Request& options) -> std::string {
            std::vector<NameOption> all;
            for (const std::string& text : texts) {
              auto one = NameOption::parse(text);
              if (!one) return one.error();
              all.push_back(std::move(*one));
            }
            options.names = std::move(all);
            return "";
          }};
}

const OptionRows<Request>& other_rows() {
  static const OptionRows<Request> rows = noted({
      {"min-angle", "WEFT_MIN_ANGLE", "Minimum angle of every triangle, in degrees. Range: 0 to 36",
       "20", number("DEG", &Request::min_angle_deg), "quality.min_angle_deg"},
      {"min-edge", "WEFT_MIN_EDGE",
       "Shortest edge that refinement may make; it takes precedence over the bounds on angle and "
       "area",
       "", number("LEN", &Request::min_edge), "quality.min_edge"},
      {"keep", "WEFT_KEEP_SEGMENTS",
       "Segments that stay as they are, by their markers, numbers or names, or all: no new point "
       "lies on them, and triangles there may miss their bounds",
       "", markers_to_keep(), "quality.keep"},
      {"periodic", "WEFT_PERIODIC",
       "Sides that repeat each other, pairs of their markers, numbers or names: they get the same "
       "vertices, moved or turned from the first to the second",
       "", periodic_sides(), "quality.periodic"},
      {"placement", "WEFT_PLACEMENT",
       "Where new points go in triangles that are too large: lattice follows the size and makes a "
       "third fewer triangles, circumcentre gives the mesh no preferred direction",
       "lattice",
       one_of(&Request::placement,
              {{"lattice", v1::PLACEMENT_LATTICE}, {"circumcentre", v1::PLACEMENT_CIRCUMCENTRE}}),
       "quality.placement"},
      {"optimise", "WEFT_OPTIMISE",
       "Sweeps of smoothing: vertices around angles below 48 degrees move to where the smallest "
       "angle around them is largest. Range: 0 to 16. Above 0, sizes that no lattice follows are "
       "refined in stages before that, for fewer triangles",
       "2 if the size makes nearly all triangles, on a lattice with few faults or in a mesh below "
       "100,000 triangles; otherwise 0",
       number("N", &Request::optimise), "quality.optimise"},
      {"snap", "WEFT_SNAP",
       "First merge points and segments of the domain that are nearer together than this",
       "only what double precision cannot keep apart", number("D", &Request::snap), "domain.snap"},
      {"simplify", "WEFT_SIMPLIFY",
       "Make the domain no finer than this share of the length of edges that the size asks for at "
       "each place: smaller islands are dropped, narrower inlets, channels and spits closed or "
       "opened, corners taken out, nothing moves farther than that",
       "every segment is meshed as it is", number("F", &Request::simplify), "simplify"},
      {"fill", "WEFT_FILL",
       "What is meshed where polygons overlap: union all that any of them covers, even-odd what an "
       "odd "
       "number of them covers, difference the first less the others",
       "union", fill_value(&Request::fill), "domain.fill"},
      {"allow-unrefined", "WEFT_ALLOW_UNREFINED",
       "Accept a mesh with triangles that miss a bound although neither the domain nor a flag "
       "forces them to",
       "such a mesh is an error", on_or_off(&Request::allow_unrefined), "allow_unrefined"},
      {"max-triangles", "WEFT_CLIENT_MAX_TRIANGLES", "Stop refining at this number of triangles",
       "", number("N", &Request::max_triangles, 1), "budget.max_triangles"},
      {"max-seconds", "WEFT_CLIENT_MAX_SECONDS", "Maximum time of work, after which the call fails",
       "", number("S", &Request::max_seconds, 0.001, 1e9), "budget.max_seconds"},
      {"threads", "WEFT_CLIENT_THREADS",
       "Threads of the server that compute; the mesh does not depend on them", "all",
       number("N", &Request::threads, 1), "threads"},
      {"no-cache", "WEFT_NO_CACHE", "Make the mesh again, even if the server has it", "",
       on_or_off(&Request::no_cache), "no_cache"},
  });
  return rows;
}

}  // namespace

OptionValue<RequestOptions> markers_to_keep() {
  return {"M,M", "", Arity::kOne,
          [](const auto& texts, const auto&, Request& options) -> std::string {
            const auto markers =
                texts.front() == "all" ? MarkerList{} : MarkerList::parse(texts.front());
            if (!markers)
              return in_quotes(texts.front()) + " does not list markers, such as 2,inlet";
            options.keep = *markers;
            return "";
          }};
}

OptionValue<RequestOptions> periodic_sides() {
  return {"M:M,M:M", "", Arity::kOne,
          [](const auto& texts, const auto&, Request& options) -> std::string {
            auto pairs = parse_marker_pairs(texts.front());
            if (!pairs)
              return in_quotes(texts.front()) + " is not pairs of markers, such as left:right,4:2";
            options.periodic = std::move(*pairs);
            return "";
          }};
}

const OptionRows<Request>& size_rows() {
  static const OptionRows<Request> rows = noted({
      {"size", "",
       "Maximum area of a triangle, taken at its centroid: a number, an expression in x, y and "
       "the names of fields, or a grid of areas in an .asc file (ESRI ASCII)",
       "no bound", size(&Request::size), "size"},
      {"edge", "",
       "Wanted length of edges, instead of --size. A triangle's area is at most that of an "
       "equilateral triangle with this edge, evaluated at its centroid. A number, an expression or "
       "a grid of lengths, as for --size",
       "no bound", size(&Request::edge), "size"},
      {"field", "",
       "A field that --edge or --size may name. KIND is distance, to all segments; "
       "distance:marker=2,inlet, to those with a marker, by number or by name; distance:FILE, to "
       "the points and lines of a "
       "domain file; width, the domain's local width; mesh:FILE[:ARRAY], values at the vertices of "
       "an earlier mesh; or FILE[:BAND], the values of a raster. May be repeated",
       "", fields(), "size.fields"},
      {"edge-at", "",
       "Maximum length LEN of edges on segments with the marker M, a number or a name. With "
       "--gradation G, the length grows from there by at most G per unit of distance. May be "
       "repeated, once per marker",
       "", edge_at(), "size.at"},
      {"gradation", "WEFT_GRADATION",
       "Maximum growth of the length of edges per unit of distance; a size that grows faster is "
       "lowered. 0.15 is common",
       "no limit", number("G", &Request::gradation, 0.001, 1000), "size.gradation"},
      {"gradation-within", "WEFT_GRADATION_WITHIN",
       "Measure distances for --gradation within the domain, around land, instead of across it", "",
       on_or_off(&Request::gradation_within), "size.gradation_within"},
      {"cells-across", "WEFT_CELLS_ACROSS",
       "Minimum number of edges across the domain, roughly: edges are at most the local width "
       "divided by N. Best with --gradation",
       "any number", number("N", &Request::cells_across, 0.01, 1e6), "size.cells_across"},
      {"points-per-circle", "WEFT_POINTS_PER_CIRCLE",
       "Minimum number of vertices on a circle: edges on arcs turn by at most 360 degrees divided "
       "by N",
       "edges turn by at most 60 degrees", number("N", &Request::points_per_circle, 1, 1e5),
       "size.points_per_circle"},
  });
  return rows;
}

const OptionRows<Request>& name_rows() {
  static const OptionRows<Request> rows = {
      {"names", "",
       "Name a marker or a region: marker=2:inlet, region=1:fluid. Replaces the name in the file, "
       "if there is one. May be repeated",
       "", names()},
  };
  return rows;
}

const OptionRows<Request>& request_rows() {
  static const OptionRows<Request> rows = [] {
    OptionRows<Request> all = size_rows();
    for (const auto* more : {&name_rows(), &other_rows()})
      all.insert(all.end(), more->begin(), more->end());
    return all;
  }();
  return rows;
}

std::string option_of(std::string_view field, const RequestOptions& options) {
  const auto name_of = [&options](const OptionRow<Request>& row) {
    return (options.from_manifest ? "" : "--") + row.name;
  };
  const OptionRow<Request>* set_by = nullptr;  // of the innermost field
  std::string parts;
  for (const OptionRow<Request>& row : request_rows()) {
    if (row.field.empty() || !options.given.contains(row.name)) continue;
    if (is_within(field, row.field)) {
      if (set_by == nullptr || row.field.size() > set_by->field.size()) set_by = &row;
    } else if (field == "size" && is_within(row.field, field)) {
      parts += (parts.empty() ? "" : ", ") + name_of(row);
    }
  }
  if (set_by == nullptr) return parts;
  const auto entry = index_in(field, set_by->field);
  if (entry && set_by->field == "size.fields" && *entry < options.fields.size())
    return name_of(*set_by) + " " + options.fields[*entry].name;
  if (entry && set_by->field == "size.at" && *entry < options.edge_at.size()) {
    const EdgeAt& at = options.edge_at[*entry];
    return name_of(*set_by) + " marker=" + (at.name.empty() ? std::to_string(at.marker) : at.name);
  }
  if (entry && set_by->field == "quality.periodic" && *entry < options.periodic.size())
    return name_of(*set_by) + " " + options.periodic[*entry].text();
  return name_of(*set_by);
}

}  // namespace weft::client
