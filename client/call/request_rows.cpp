// SPDX-License-Identifier: Apache-2.0
#include "client/call/request_rows.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/base/text.h"
#include "files/formats/derived/vertex_values.h"
#include "files/formats/domain_formats.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/raster.h"
#include "files/message/field_path.h"
#include "wire/marker_options.h"
#include "wire/named_options.h"

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

// Texts that `parse` reads, one after the other.
template <class Item, class Parse>
OptionValue<Request> list(std::string unit, std::vector<Item> Request::*field, Parse parse) {
  return {std::move(unit), "", Arity::kList,
          [field, parse](const auto& texts, const auto& folder, Request& options) -> std::string {
            std::vector<Item> all;
            for (const std::string& text : texts) {
              auto one = parse(text, folder);
              if (!one) return one.error();
              all.push_back(std::move(*one));
            }
            options.*field = std::move(all);
            return "";
          }};
}

// One that weft.v1 names, with a value that it has for a text.
OptionRow<Request> named(const wire::NamedOption& option) {
  const v1::Option& text = option.annotation;
  return {text.name(),
          text.variable(),
          text.about(),
          text.default_(),
          {text.unit(), option.range(), option.is_switch() ? Arity::kSwitch : Arity::kOne,
           [&option](const auto& texts, const auto&, Request& options) -> std::string {
             const std::string fault = set(option, texts.front(), options.asked);
             return fault.empty() ? "" : in_quotes(texts.front()) + " is not " + fault;
           }},
          option.path};
}

const wire::MarkerOption& marker_option(std::string_view name) {
  return *std::ranges::find(wire::marker_options(), name, &wire::MarkerOption::name);
}

// Those that name markers, of a part of the request.
void add_of_markers(std::string_view part, OptionRows<Request>& rows) {
  for (const wire::MarkerOption& option : wire::marker_options())
    if (option.path.starts_with(part))
      rows.push_back({option.name, option.variable,
                      option.about + (option.repeats ? ". May be repeated" : ""), "",
                      marker_value(option.name), option.path});
}

// Those whose fields begin so. The quadtree is asked for by what draws it.
void add_named(std::string_view part, OptionRows<Request>& rows) {
  for (const wire::NamedOption& option : wire::named_options())
    if (option.path.starts_with(part) && option.path != "want_quadtree")
      rows.push_back(named(option));
}

const OptionRows<Request>& other_rows() {
  static const OptionRows<Request> rows = [] {
    OptionRows<Request> all;
    add_named("quality.", all);
    add_of_markers("quality.", all);
    all.push_back(
        {"fill", "WEFT_FILL",
         "What is meshed where polygons overlap: union all that any of them covers, even-odd what "
         "an odd number of them covers, difference the first less the others",
         "union", fill_value(&Request::fill), "domain.fill"});
    add_named("domain.", all);
    for (const wire::NamedOption& option : wire::named_options())
      if (option.part == nullptr && option.path != "want_quadtree") all.push_back(named(option));
    add_named("budget.", all);
    return noted(std::move(all));
  }();
  return rows;
}

}  // namespace

OptionValue<RequestOptions> marker_value(std::string_view name) {
  const wire::MarkerOption& option = marker_option(name);
  return {option.unit, "", option.repeats ? Arity::kList : Arity::kOne,
          [&option](const auto& texts, const auto&, Request& options) -> std::string {
            option.clear(options.markers);
            for (const std::string& text : texts)
              if (std::string fault = option.read(text, options.markers); !fault.empty())
                return fault;
            return "";
          }};
}

const OptionRows<Request>& size_rows() {
  static const OptionRows<Request> rows = [] {
    OptionRows<Request> all = {
        {"size", "",
         "Maximum area of a triangle, taken at its centroid: a number, an expression in x, y and "
         "the names of fields, or a grid of areas in an .asc file (ESRI ASCII)",
         "no bound", size(&Request::size), "size"},
        {"edge", "",
         "Wanted length of edges, instead of --size. A triangle's area is at most that of an "
         "equilateral triangle with this edge, evaluated at its centroid. A number, an expression "
         "or "
         "a grid of lengths, as for --size",
         "no bound", size(&Request::edge), "size"},
        {"field", "",
         "A field that --edge or --size may name. KIND is distance, to all segments; "
         "distance:marker=2,inlet, to those with a marker, by number or by name; distance:FILE, to "
         "the points and lines of a "
         "domain file; width, the domain's local width; mesh:FILE[:ARRAY], values at the vertices "
         "of "
         "an earlier mesh; or FILE[:BAND], the values of a raster. May be repeated",
         "", list("NAME=KIND", &Request::fields, FieldOption::parse), "size.fields"},
    };
    add_of_markers("size.", all);
    add_named("size.", all);
    return noted(std::move(all));
  }();
  return rows;
}

const OptionRows<Request>& name_rows() {
  static const OptionRows<Request> rows = {
      {"names", "",
       "Name a marker or a region: marker=2:inlet, region=1:fluid. Replaces the name in the file, "
       "if there is one. May be repeated",
       "",
       list("KIND=ID:NAME", &Request::names,
            [](const std::string& text, const auto&) { return NameOption::parse(text); })},
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
  if (!entry) return name_of(*set_by);
  if (set_by->field == "size.fields" && *entry < options.fields.size())
    return name_of(*set_by) + " " + options.fields[*entry].name;
  for (const wire::MarkerOption& option : wire::marker_options())
    if (option.path == set_by->field)
      if (const std::string text = option.entry(options.markers, *entry); !text.empty())
        return name_of(*set_by) + " " + text;
  return name_of(*set_by);
}

}  // namespace weft::client
