// SPDX-License-Identifier: Apache-2.0
#include "server/http/mesh_wish.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "files/base/did_you_mean.h"
#include "files/base/text.h"
#include "files/base/value_of.h"
#include "files/formats/domain_formats.h"
#include "files/geo/projection.h"
#include "files/message/field_path.h"
#include "server/http/formats.h"
#include "wire/marker_options.h"
#include "wire/named_options.h"

namespace weft::server {
namespace {

using files::in_quotes;
using files::value_of;
using Type = Parameter::Type;
using Use = ParameterUse;

std::string read_switch(const std::string& text, bool& value) {
  constexpr std::string_view kOn[] = {"", "true", "1", "on", "yes"};
  constexpr std::string_view kOff[] = {"false", "0", "off", "no"};
  value = std::ranges::find(kOn, text) != std::end(kOn);
  const bool good = value || std::ranges::find(kOff, text) != std::end(kOff);
  return good ? "" : in_quotes(text) + " is not true or false";
}

// Sets a size: a number or an expression.
std::string read_size(const std::string& text, v1::Measure measure, MeshWish& wish) {
  v1::SizeField& size = *wish.request.mutable_size();
  if (size.field_case() != v1::SizeField::FIELD_NOT_SET)
    return "excludes the other one of size and edge";
  if (text.empty()) return "is neither a number nor an expression";
  const auto constant = value_of<double>(text);
  if (constant && std::isfinite(*constant))
    size.set_constant(*constant);
  else
    size.set_expression(text);
  size.set_measure(measure);
  return "";
}

std::string read_field(const std::string& text, MeshWish& wish) {
  const auto equals = std::min(text.find('='), text.size());
  auto field = wire::DomainField::parse(text.substr(std::min(equals + 1, text.size())));
  if (equals == 0 || !field)
    return in_quotes(text) +
           " is not NAME=KIND, whose kinds are distance, distance:marker=M,M and width";
  if (!*field) return field->error();
  wish.fields.push_back({text.substr(0, equals), std::move(**field)});
  return "";
}

template <class T>
std::function<std::string(const std::string&, MeshWish&)> one_of(
    T MeshWish::*member, std::vector<std::pair<std::string, T>> values) {
  return [member, values = std::move(values)](const std::string& text, MeshWish& wish) {
    for (const auto& [name, value] : values)
      if (name == text) {
        wish.*member = value;
        return std::string();
      }
    return in_quotes(text) + " is not one of the choices";
  };
}

// An EPSG code: PROJ opens files that other names ask for.
std::string read_crs(const std::string& text, MeshWish& wish) {
  constexpr std::string_view kStart = "EPSG:";
  constexpr std::size_t kMaxDigits = 6;
  const std::string code = text.substr(std::min(kStart.size(), text.size()));
  if (!text.starts_with(kStart) || code.empty() || code.size() > kMaxDigits ||
      code.find_first_not_of("0123456789") != std::string::npos)
    return in_quotes(text) + " is not a code such as EPSG:32618";
  wish.projection.crs = text;
  return "";
}

std::vector<Parameter> own_parameters() {
  using files::MshVersion;
  using files::PolygonFill;
  std::vector<Parameter> all = {
      {"edge",
       Type::kText,
       "Wanted length of edges: a number, or an expression in x and y; excludes size",
       {},
       false,
       Use::kDomain,
       "size",
       [](const std::string& text, MeshWish& wish) {
         return read_size(text, v1::MEASURE_EDGE, wish);
       }},
      {"size",
       Type::kText,
       "Maximum area of a triangle at its centroid: a number, or an expression in x and y; "
       "excludes "
       "edge",
       {},
       false,
       Use::kDomain,
       "size",
       [](const std::string& text, MeshWish& wish) {
         return read_size(text, v1::MEASURE_AREA, wish);
       }},
      {"field",
       Type::kText,
       "A field that size or edge may name: coast=distance, to all segments, "
       "inlet=distance:marker=2,inlet, to those with a marker, or w=width, the domain's local "
       "width. In a form, each file but that of the domain is a field, too, of the values of an "
       ".asc grid",
       {},
       true,
       Use::kDomain,
       "size.fields",
       read_field},
      {"names",
       Type::kText,
       "Name of a marker or a region: marker=2:inlet or region=1:fluid",
       {},
       true,
       Use::kDomain,
       "",
       [](const std::string& text, MeshWish& wish) {
         const auto one = files::NameOption::parse(text);
         if (one) wish.names.push_back(*one);
         return one ? "" : one.error();
       }},
      {"fill",
       Type::kText,
       "What is meshed where polygons overlap: all that any of them covers, what an odd number of "
       "them covers, or the first less the others. Default: union",
       {"union", "even-odd", "difference"},
       false,
       Use::kDomain,
       "domain.fill",
       one_of(&MeshWish::fill, {{"union", PolygonFill::kUnion},
                                {"even-odd", PolygonFill::kEvenOdd},
                                {"difference", PolygonFill::kDifference}})},
      {"lonlat",
       Type::kSwitch,
       "The domain is in longitude and latitude, in degrees, and so is the mesh; it is meshed in "
       "metres",
       {},
       false,
       Use::kDomain,
       "",
       [](const std::string& text, MeshWish& wish) {
         return read_switch(text, wish.projection.lonlat);
       }},
      {"crs",
       Type::kText,
       "Projection of a domain in longitude and latitude, such as EPSG:32618; implies lonlat. "
       "Default: the conformal one whose scale varies least over the domain",
       {},
       false,
       Use::kDomain,
       "",
       read_crs},
      {"to_metres",
       Type::kSwitch,
       "Write the mesh in metres of the projection; implies lonlat",
       {},
       false,
       Use::kDomain,
       "",
       [](const std::string& text, MeshWish& wish) {
         return read_switch(text, wish.projection.to_metres);
       }},
      {"from", Type::kText,
       "Format of the domain's file. Default: that of the name in the path, of Content-Type, or "
       "what the file looks like",
       read_formats(), false, Use::kDomain, "",
       [](const std::string& text, MeshWish& wish) {
         wish.from = "." + text;
         return "";
       }},
      {"format", Type::kText, "Format of the mesh's file. Default: what Accept asks for, or vtu",
       written_formats(), false, Use::kFile, "",
       [](const std::string& text, MeshWish& wish) {
         wish.to = "." + text;
         return "";
       }},
      {"stream",
       Type::kSwitch,
       "Send the file while the mesh is made, as geojson alone can be: its figures and warnings "
       "come "
       "after it, as trailers, and if the mesh fails, the answer breaks off",
       {},
       false,
       Use::kArrival,
       "",
       [](const std::string& text, MeshWish& wish) { return read_switch(text, wish.stream); }},
      {"order",
       Type::kText,
       "2: triangles of six nodes, for formats that have them. Default: 1",
       {"1", "2"},
       false,
       Use::kFile,
       "",
       [](const std::string& text, MeshWish& wish) {
         wish.writing.order = text == "2" ? 2 : 1;
         return "";
       }},
      {"msh_version",
       Type::kText,
       "Version of .msh files. Default: 4.1",
       {"2.2", "4.1"},
       false,
       Use::kFile,
       "",
       [](const std::string& text, MeshWish& wish) {
         wish.writing.msh_version = text == "2.2" ? MshVersion::k22 : MshVersion::k41;
         return "";
       }},
      {"open_boundary",
       Type::kText,
       "Markers of open boundaries in files of ADCIRC and SCHISM, numbers or names: 2,inlet",
       {},
       false,
       Use::kFile,
       "",
       [](const std::string& text, MeshWish& wish) {
         const auto list = files::MarkerList::parse(text);
         if (!list) return in_quotes(text) + " does not list markers, such as 2,inlet";
         wish.writing.open_boundaries = list->markers;
         wish.writing.open_boundary_names = list->names;
         return std::string();
       }},
      {"timeout",
       Type::kNumber,
       "Seconds after which the request is given up",
       {},
       false,
       Use::kWaiting,
       "",
       [](const std::string& text, MeshWish& wish) {
         constexpr double kMax = 1e9;
         wish.timeout = value_of<double>(text);
         const bool good = wish.timeout && *wish.timeout > 0 && *wish.timeout <= kMax;
         return good ? "" : in_quotes(text) + " is not in the range above 0 to 1e9";
       }},
      {"request_id",
       Type::kText,
       "A name for the job, unique among those of the client: the same request with it again finds "
       "the same job",
       {},
       false,
       Use::kJob,
       "",
       [](const std::string& text, MeshWish& wish) {
         wish.request_id = text;
         return "";
       }},
      {"notify",
       Type::kText,
       "URL that is told of the job's end, by a POST of what /v1/jobs/{id} answers then, signed as "
       "Standard Webhooks are. Default: the one that the server has for the client",
       {},
       false,
       Use::kJob,
       "notify",
       [](const std::string& text, MeshWish& wish) {
         wish.notify = text;
         return "";
       }},
  };
  return all;
}

std::string with_underscores(std::string name) {
  std::ranges::replace(name, '-', '_');
  return name;
}

Type type_of(const wire::NamedOption& option) {
  using google::protobuf::FieldDescriptor;
  if (option.is_switch()) return Type::kSwitch;
  if (option.field->cpp_type() == FieldDescriptor::CPPTYPE_DOUBLE) return Type::kNumber;
  return option.field->enum_type() != nullptr ? Type::kText : Type::kCount;
}

// One that weft.v1 names.
Parameter named(const wire::NamedOption& option) {
  const v1::Option& text = option.annotation;
  std::string about = text.about();
  if (const std::string range = option.range(); !range.empty()) about += ". Range: " + range;
  if (!text.default_().empty()) about += ". Default: " + text.default_();
  const auto read = [&option](const std::string& given, MeshWish& wish) {
    const std::string value = option.is_switch() && given.empty() ? "true" : given;
    const std::string fault = wire::set(option, value, wish.request);
    return fault.empty() ? "" : in_quotes(given) + " is not " + fault;
  };
  return {with_underscores(option.name()),
          type_of(option),
          about,
          {},
          false,
          Use::kDomain,
          option.path,
          read};
}

// One that names markers.
Parameter of_markers(const wire::MarkerOption& option) {
  return {with_underscores(option.name),
          Type::kText,
          option.about + ". Form: " + option.unit,
          {},
          option.repeats,
          Use::kDomain,
          option.path,
          [&option](const std::string& text, MeshWish& wish) {
            return option.read(text, wish.markers);
          }};
}

Problem bad_parameter(const std::string& name, const std::string& why) {
  return {.status = 400, .reason = "BAD_OPTION", .detail = name + ": " + why, .field = name};
}

const Parameter* find_parameter(const std::string& name) {
  const auto found = std::ranges::find(mesh_parameters(), with_underscores(name), &Parameter::name);
  return found == mesh_parameters().end() ? nullptr : &*found;
}

Problem no_such_parameter(const std::string& name) {
  std::vector<std::string> names;
  for (const Parameter& parameter : mesh_parameters()) names.push_back(parameter.name);
  const std::string meant = files::did_you_mean(with_underscores(name), names);
  return bad_parameter(in_quotes(name),
                       "there is no such parameter" + (meant.empty() ? "" : "; " + meant));
}

}  // namespace

const std::vector<Parameter>& mesh_parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> parameters = own_parameters();
    for (const wire::MarkerOption& option : wire::marker_options())
      parameters.push_back(of_markers(option));
    for (const wire::NamedOption& option : wire::named_options())
      if (option.path != "want_quadtree") parameters.push_back(named(option));  // no file has it
    return parameters;
  }();
  return all;
}

std::vector<const Parameter*> parameters_for(ParameterUses uses) {
  std::vector<const Parameter*> some;
  for (const Parameter& parameter : mesh_parameters())
    if ((static_cast<ParameterUses>(parameter.use) & uses) != 0) some.push_back(&parameter);
  return some;
}

tl::expected<MeshWish, Problem> read_wish(const Query& query, ParameterUses uses) {
  MeshWish wish;
  std::set<const Parameter*> given;
  for (const auto& [name, text] : query) {
    const Parameter* const parameter = find_parameter(name);
    if (parameter == nullptr) return tl::unexpected(no_such_parameter(name));
    if ((static_cast<ParameterUses>(parameter->use) & uses) == 0)
      return tl::unexpected(bad_parameter(name, "is of no use here"));
    if (!given.insert(parameter).second && !parameter->repeats)
      return tl::unexpected(bad_parameter(name, "is given twice"));
    const auto& choices = parameter->choices;
    if (!choices.empty() && std::ranges::find(choices, text) == choices.end()) {
      std::string list;
      for (const std::string& choice : choices) list += (list.empty() ? "" : ", ") + choice;
      Problem problem = bad_parameter(name, in_quotes(text) + " is none of " + list);
      if (name == "from") problem.status = 415;
      if (name == "format") problem.status = 406;
      return tl::unexpected(std::move(problem));
    }
    if (const std::string fault = parameter->read(text, wish); !fault.empty())
      return tl::unexpected(bad_parameter(name, fault));
  }
  return wish;
}

std::optional<Problem> complete(const files::NameTable& markers, MeshWish& wish) {
  if (const auto fault = wire::fill(wish.markers, markers, wish.request))
    for (const wire::MarkerOption& option : wire::marker_options())
      if (files::is_within(fault->field, option.path))
        return bad_parameter(with_underscores(option.name), fault->error.message);
  wish.writing.periodic = wire::periodic_sides(wish.request.quality());
  for (const NamedDomainField& given : wish.fields) {
    v1::NamedField& field = *wish.request.mutable_size()->add_fields();
    field.set_name(given.name);
    if (const auto ok = wire::fill(given.field, markers, field); !ok)
      return bad_parameter("field", ok.error().message);
  }
  if (const auto found = find_open_boundaries(wish.writing, markers); !found)
    return bad_parameter("open_boundary", found.error().message);
  return std::nullopt;
}

std::string parameter_of(std::string_view field, const Query& query) {
  std::string name;
  std::size_t longest = 0;  // the innermost field
  for (const auto& [given, text] : query) {
    const Parameter* const parameter = find_parameter(given);
    if (parameter == nullptr || parameter->field.empty()) continue;
    if (!files::is_within(field, parameter->field) || parameter->field.size() < longest) continue;
    longest = parameter->field.size();
    name = given;
  }
  return name;
}

}  // namespace weft::server
