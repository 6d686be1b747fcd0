// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/geojson.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/base/text.h"
#include "files/base/words.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/json_text.h"
#include "files/formats/domains/feature_properties.h"
#include "files/formats/domains/geometry_builder.h"

namespace weft::files {
namespace {

using Json = nlohmann::json;

// Parsed JSON takes up to twenty times the memory of its text.
constexpr std::uint64_t kMaxJsonBytes = std::uint64_t{512} << 20;
constexpr int kMaxJsonDepth = 64;

// What the names of systems in longitude and latitude end with: of WGS 84, and of those that the
// coastlines and boundaries of many countries come in.
constexpr std::string_view kWgs84[] = {"crs84", "4326", "4979"};
constexpr std::string_view kGeographic[] = {"crs27", "crs83", "4258", "4267", "4269",
                                            "4283",  "4490",  "4617", "4674", "7844"};

// GeoJSON is in longitude and latitude, but drawings in a plane are written as GeoJSON, too: most
// of these lie around the origin, or have round coordinates.
bool looks_geographic(const std::vector<Point>& points) {
  double west = 180, east = -180, south = 90, north = -90;
  std::size_t fine = 0;  // coordinates of more than three decimals
  for (const Point p : points) {
    west = std::min(west, p.x);
    east = std::max(east, p.x);
    south = std::min(south, p.y);
    north = std::max(north, p.y);
    for (const double value : {p.x, p.y})
      fine += std::abs(1000 * value - std::round(1000 * value)) > 1e-6 ? 1 : 0;
  }
  const bool on_earth = -180 <= west && east <= 180 && -90 <= south && north <= 90;
  const bool around_origin = west <= 0 && 0 <= east && south <= 0 && 0 <= north;
  return on_earth && !around_origin && fine >= points.size();
}

class Reader {
 public:
  Reader(const std::string& name, bool lonlat) : name_(name), builder_(name, lonlat) {}

  Result<Domain> read(const Json& root) {
    if (auto read = object(root, "", {}); !read) return tl::unexpected(read.error());
    auto domain = builder_.finish();
    if (!domain) return domain;
    const std::string system = system_of(root);
    const std::string code = lower_case(system.substr(system.find_last_of(":/#") + 1));
    const bool is_wgs84 = std::ranges::find(kWgs84, code) != std::end(kWgs84);
    if (is_wgs84 || std::ranges::find(kGeographic, code) != std::end(kGeographic))
      domain->system = CoordinateSystem{harmless(system), true, kLonLat};
    else if (system.empty() && looks_geographic(domain->points))
      domain->system = CoordinateSystem{"RFC 7946", true, kLonLat};
    if (!system.empty() && !is_wgs84)
      domain->warnings.push_back(
          {.kind = WarningKind::kCoordinates,
           .file = name_,
           .place = "crs",
           .text = "its crs is " + in_quotes(system) +
                   ", not WGS 84 as GeoJSON's is; coordinates are taken as they are"});
    return domain;
  }

 private:
  // What the member `crs` names, if anything.
  static std::string system_of(const Json& root) {
    const auto crs = root.find("crs");
    if (crs == root.end() || crs->is_null()) return "";
    static const Json::json_pointer kName("/properties/name");
    if (!crs->contains(kName) || !crs->at(kName).is_string()) return shown(*crs);
    return crs->at(kName).get<std::string>();
  }
  tl::unexpected<Error> bad(const std::string& path, const std::string& what) const {
    return builder_.bad(path, what);
  }
  static std::string member(const std::string& path, const char* name) {
    return path.empty() ? name : path + "." + name;
  }
  static std::string element(const std::string& path, std::size_t i) {
    return path + "[" + std::to_string(i) + "]";
  }

  // Reads the objects of the array that is the member `name` of `parent`.
  Result<void> objects(const Json& parent, const char* name, const std::string& path,
                       const GeometryProperties& properties) {
    const auto found = parent.find(name);
    if (found == parent.end() || !found->is_array())
      return bad(path, std::string("has no array \"") + name + "\"");
    for (std::size_t i = 0; i < found->size(); ++i) {
      const std::string where = element(member(path, name), i);
      if ((*found)[i].is_null()) {
        builder_.leave_out(LeftOut::kGeometry, where);
      } else if (auto read = object((*found)[i], where, properties); !read) {
        return read;
      }
    }
    return {};
  }

  Result<void> object(const Json& json, const std::string& path,
                      const GeometryProperties& properties) {
    if (json.is_array() && path.empty())
      return bad(path,
                 "is a list, and GeoJSON is an object: write {\"type\": \"GeometryCollection\", "
                 "\"geometries\": [...]} around geometries, or {\"type\": \"FeatureCollection\", "
                 "\"features\": [...]} around features");
    if (!json.is_object()) return bad(path, "is not a GeoJSON object");
    const auto type = json.find("type");
    const bool is_of_esri = json.contains("geometryType") || json.contains("rings") ||
                            json.contains("paths") || json.contains("spatialReference");
    if (type == json.end() && is_of_esri)
      return bad(path,
                 "is JSON of Esri, not GeoJSON: ask its server for f=geojson, or convert it with "
                 "ogr2ogr -f GeoJSON OUT.geojson ESRIJSON:" +
                     name_);
    if (type == json.end() || !type->is_string()) return bad(path, "has no string \"type\"");
    const auto& name = type->get_ref<const std::string&>();
    if (name == "FeatureCollection") return objects(json, "features", path, properties);
    if (name == "GeometryCollection") return objects(json, "geometries", path, properties);
    if (name == "Feature") {
      const auto geometry = json.find("geometry");
      if (geometry == json.end()) return bad(path, "has no \"geometry\"");
      if (geometry->is_null()) return {};
      const auto own = feature_properties(json, path);
      if (!own) return tl::unexpected(own.error());
      return object(*geometry, member(path, "geometry"), *own);
    }
    return geometry(json, name, path, properties);
  }

  // For messages.
  static std::string shown(const Json& value) {
    constexpr std::size_t kMax = 40;
    std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
    return text.size() > kMax ? text.substr(0, kMax) + "..." : text;
  }

  // The member of this name; otherwise the first, in the order of the alphabet, that only capitals
  // tell apart, as databases write them.
  static Json::const_iterator find_property(const Json& properties, const char* name) {
    auto found = properties.find(name);
    for (auto each = properties.begin(); found == properties.end() && each != properties.end();
         ++each)
      if (lower_case(each.key()) == name) found = each;
    return found;
  }

  Result<GeometryProperties> feature_properties(const Json& feature, const std::string& path) {
    const auto found = feature.find("properties");
    if (found == feature.end() || !found->is_object()) return GeometryProperties{};
    return files::feature_properties(builder_, member(path, "properties") + ".",
                                     [&found](const char* name) -> PropertyValue {
                                       const auto value = find_property(*found, name);
                                       if (value == found->end() || value->is_null()) return {};
                                       if (value->is_number())
                                         return {value->get<double>(), "", ""};
                                       if (value->is_string())
                                         return {std::nullopt, value->get<std::string>(), ""};
                                       return {std::nullopt, "", shown(*value)};
                                     });
  }

  Result<void> geometry(const Json& json, const std::string& type, const std::string& path,
                        const GeometryProperties& properties) {
    using Part =
        Result<void> (Reader::*)(const Json&, const std::string&, const GeometryProperties&);
    struct Kind {
      std::string_view name;
      Part part;
      bool many;
    };
    static constexpr Kind kKinds[] = {
        {"Point", &Reader::point, false},     {"MultiPoint", &Reader::point, true},
        {"LineString", &Reader::line, false}, {"MultiLineString", &Reader::line, true},
        {"Polygon", &Reader::polygon, false}, {"MultiPolygon", &Reader::polygon, true},
    };
    const auto kind = std::find_if(std::begin(kKinds), std::end(kKinds),
                                   [&type](const Kind& k) { return k.name == type; });
    if (kind == std::end(kKinds))
      return bad(path,
                 "has the type " + in_quotes(type) + ", which is not GeoJSON's" +
                     (type == "Topology" ? "; TopoJSON is read from files named .topojson" : ""));
    const auto coordinates = json.find("coordinates");
    if (coordinates == json.end() || !coordinates->is_array())
      return bad(path, "has no array \"coordinates\"");
    const std::string where = member(path, "coordinates");
    if (coordinates->empty()) {  // RFC 7946 allows it
      builder_.leave_out(LeftOut::kGeometry, path.empty() ? "the geometry" : path);
      return {};
    }
    if (!kind->many) return (this->*kind->part)(*coordinates, where, properties);
    for (std::size_t i = 0; i < coordinates->size(); ++i) {
      const Json& part = (*coordinates)[i];
      if (part.is_array() && part.empty())
        builder_.leave_out(LeftOut::kGeometry, element(where, i));
      else if (auto read = (this->*kind->part)(part, element(where, i), properties); !read)
        return read;
    }
    return {};
  }

  Result<Point> position(const Json& json, const std::string& path) const {
    if (!json.is_array() || json.size() < 2 || !json[0].is_number() || !json[1].is_number())
      return bad(path, "is not a position [x, y]");
    return Point{json[0].get<double>(), json[1].get<double>()};
  }

  Result<std::vector<Point>> positions(const Json& json, const std::string& path) const {
    if (!json.is_array()) return bad(path, "is not an array of positions");
    std::vector<Point> points;
    points.reserve(json.size());
    for (std::size_t i = 0; i < json.size(); ++i) {
      const auto at = position(json[i], element(path, i));
      if (!at) return tl::unexpected(at.error());
      points.push_back(*at);
    }
    return points;
  }

  Result<void> point(const Json& json, const std::string& path, const GeometryProperties&) {
    const auto at = position(json, path);
    if (!at) return tl::unexpected(at.error());
    return builder_.point(*at, path);
  }

  Result<void> line(const Json& json, const std::string& path,
                    const GeometryProperties& properties) {
    const auto points = positions(json, path);
    if (!points) return tl::unexpected(points.error());
    return builder_.line(*points, path, properties);
  }

  Result<void> polygon(const Json& json, const std::string& path,
                       const GeometryProperties& properties) {
    if (!json.is_array()) return bad(path, "is not an array of rings");
    builder_.begin_polygon();
    for (std::size_t i = 0; i < json.size(); ++i) {
      const auto points = positions(json[i], element(path, i));
      if (!points) return tl::unexpected(points.error());
      if (auto added = builder_.ring(*points, element(path, i), properties); !added) return added;
    }
    builder_.end_polygon(path, properties);
    return {};
  }

  const std::string name_;
  GeometryBuilder builder_;
};

}  // namespace

Result<Domain> read_geojson(const std::filesystem::path& path, bool lonlat) {
  const auto contents = read_text_file(path, kMaxJsonBytes);
  if (!contents) return tl::unexpected(contents.error());
  try {
    const auto json = parse_json(path.string(), contents->text(), kMaxJsonDepth);
    if (!json) return tl::unexpected(json.error());
    return Reader(path.string(), lonlat).read(*json);
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": not enough memory to read it");
  }
}

}  // namespace weft::files
