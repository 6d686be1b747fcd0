// SPDX-License-Identifier: Apache-2.0
#include "client/formats/geojson.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "client/formats/file_contents.h"
#include "client/formats/interior_point.h"
#include "client/formats/json_text.h"
#include "client/formats/ring_crossing.h"
#include "client/text.h"

namespace weft::client {
namespace {

using Json = nlohmann::json;

// Parsed JSON takes up to twenty times the room of its text.
constexpr std::uint64_t kMaxJsonBytes = std::uint64_t{512} << 20;
constexpr int kMaxJsonDepth = 64;

// What a Feature says of its geometry.
struct Properties {
  std::int32_t marker = 0;
  std::optional<std::int32_t> region;
  std::optional<double> max_area;
};

class Reader {
 public:
  explicit Reader(std::string name) : name_(std::move(name)) {}

  Result<Domain> read(const Json& root) {
    if (auto read = object(root, "", {}); !read) return tl::unexpected(read.error());
    if (domain_.points.empty()) return bad("", "holds no geometry");
    return finish();
  }

 private:
  // A polygon that asks for a region, and its path.
  struct RegionPolygon {
    PolygonRange range;
    Properties properties;
    std::string path;
  };

  tl::unexpected<Error> bad(const std::string& path, const std::string& what) const {
    return fail(ExitCode::kUnreadableInput, name_ + ": " + (path.empty() ? "" : path + " ") + what);
  }
  static std::string member(const std::string& path, const char* name) {
    return path.empty() ? name : path + "." + name;
  }
  static std::string element(const std::string& path, std::size_t i) {
    return path + "[" + std::to_string(i) + "]";
  }

  // Reads members `name` of `parent`, an array of GeoJSON objects.
  Result<void> objects(const Json& parent, const char* name, const std::string& path,
                       const Properties& properties) {
    const auto found = parent.find(name);
    if (found == parent.end() || !found->is_array())
      return bad(path, std::string("has no array \"") + name + "\"");
    for (std::size_t i = 0; i < found->size(); ++i)
      if (auto read = object((*found)[i], element(member(path, name), i), properties); !read)
        return read;
    return {};
  }

  Result<void> object(const Json& json, const std::string& path, const Properties& properties) {
    if (!json.is_object()) return bad(path, "is not a GeoJSON object");
    const auto type = json.find("type");
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

  Result<Properties> feature_properties(const Json& feature, const std::string& path) const {
    Properties out;
    const auto found = feature.find("properties");
    if (found == feature.end() || !found->is_object()) return out;
    const std::string where = member(path, "properties");
    const auto integer = [&](const char* name) -> Result<std::optional<std::int32_t>> {
      const auto value = found->find(name);
      if (value == found->end() || !value->is_number()) return std::nullopt;
      const double number = value->get<double>();
      constexpr double kMax = std::numeric_limits<std::int32_t>::max();
      if (!(number >= -kMax - 1 && number <= kMax) ||
          number != static_cast<double>(static_cast<std::int32_t>(number)))
        return bad(member(where, name), "is " + shortest(number) + ", not an integer of 32 bits");
      return static_cast<std::int32_t>(number);
    };
    const auto marker = integer("marker");
    if (!marker) return tl::unexpected(marker.error());
    out.marker = marker->value_or(0);
    const auto region = integer("region");
    if (!region) return tl::unexpected(region.error());
    out.region = *region;
    const auto area = found->find("max_area");
    if (area != found->end() && area->is_number()) {
      out.max_area = area->get<double>();
      if (!(*out.max_area > 0))
        return bad(member(where, "max_area"), "is " + shortest(*out.max_area) + ", not positive");
    }
    return out;
  }

  Result<void> geometry(const Json& json, const std::string& type, const std::string& path,
                        const Properties& properties) {
    using Part = Result<void> (Reader::*)(const Json&, const std::string&, const Properties&);
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
      return bad(path, "has the type " + in_quotes(type) + ", which is not GeoJSON's");
    const auto coordinates = json.find("coordinates");
    if (coordinates == json.end() || !coordinates->is_array())
      return bad(path, "has no array \"coordinates\"");
    const std::string where = member(path, "coordinates");
    if (coordinates->empty()) return {};  // RFC 7946 allows it: no geometry
    if (!kind->many) return (this->*kind->part)(*coordinates, where, properties);
    for (std::size_t i = 0; i < coordinates->size(); ++i)
      if (auto read = (this->*kind->part)((*coordinates)[i], element(where, i), properties); !read)
        return read;
    return {};
  }

  Result<Point> position(const Json& json, const std::string& path) const {
    if (!json.is_array() || json.size() < 2 || !json[0].is_number() || !json[1].is_number())
      return bad(path, "is not a position [x, y]");
    const Point at{json[0].get<double>(), json[1].get<double>()};
    // The limit of the service, and what keeps the predicates from overflow.
    constexpr double kLargest = 1e50;
    if (!(std::abs(at.x) <= kLargest && std::abs(at.y) <= kLargest))
      return bad(path, "is " + coordinates(at.x, at.y) + ", magnitudes go up to 1e50");
    return at;
  }

  // Reads the positions and drops those that repeat their predecessor. `kept[i]` is the number that
  // the i-th has in the file.
  Result<void> positions(const Json& json, const std::string& path, std::vector<Point>& points,
                         std::vector<std::size_t>& kept) const {
    if (!json.is_array()) return bad(path, "is not an array of positions");
    points.reserve(json.size());
    kept.reserve(json.size());
    for (std::size_t i = 0; i < json.size(); ++i) {
      const auto at = position(json[i], element(path, i));
      if (!at) return tl::unexpected(at.error());
      if (!points.empty() && points.back() == *at) continue;
      points.push_back(*at);
      kept.push_back(i);
    }
    return {};
  }

  Result<void> point(const Json& json, const std::string& path, const Properties&) {
    const auto at = position(json, path);
    if (!at) return tl::unexpected(at.error());
    domain_.point_places.add(domain_.points.size(), name_ + ": " + path + ", point ", 0, "");
    domain_.points.push_back(*at);
    return {};
  }

  // Adds the points, and the segments between neighbours; of a ring the last leads to the first.
  Result<void> chain(const std::vector<Point>& points, const std::vector<std::size_t>& kept,
                     bool closed, const std::string& path, const Properties& properties) {
    const std::size_t first = domain_.points.size();
    if (points.size() > std::numeric_limits<std::uint32_t>::max() - first)
      return bad(path, "makes more than 4294967295 points");
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i == 0 || kept[i] != kept[i - 1] + 1)
        domain_.point_places.add(first + i, name_ + ": " + path + "[", kept[i], "]");
    }
    domain_.points.insert(domain_.points.end(), points.begin(), points.end());
    const std::size_t count = points.size() - (closed ? 0 : 1);
    for (std::size_t i = 0; i < count; ++i) {
      if (i == 0 || kept[i] != kept[i - 1] + 1)
        domain_.segment_places.add(domain_.segments.size(), name_ + ": " + path + ", edge from [",
                                   kept[i], "]");
      const std::size_t next = i + 1 < points.size() ? i + 1 : 0;
      domain_.segments.push_back({static_cast<std::uint32_t>(first + i),
                                  static_cast<std::uint32_t>(first + next), properties.marker});
    }
    return {};
  }

  Result<void> line(const Json& json, const std::string& path, const Properties& properties) {
    std::vector<Point> points;
    std::vector<std::size_t> kept;
    if (auto read = positions(json, path, points, kept); !read) return read;
    if (points.size() < 2) return bad(path, "is a line with fewer than 2 distinct points");
    const std::size_t first = domain_.segments.size();
    if (auto added = chain(points, kept, false, path, properties); !added) return added;
    lines_.push_back({first, domain_.segments.size(), path});
    return {};
  }

  Result<void> polygon(const Json& json, const std::string& path, const Properties& properties) {
    if (!json.is_array()) return bad(path, "is not an array of rings");
    const std::size_t first = domain_.segments.size();
    for (std::size_t i = 0; i < json.size(); ++i)
      if (auto read = ring(json[i], element(path, i), properties); !read) return read;
    domain_.fill = Domain::Fill::kEvenOdd;
    if (properties.region || properties.max_area)
      region_polygons_.push_back({{first, domain_.segments.size()}, properties, path});
    return {};
  }

  Result<void> ring(const Json& json, const std::string& path, const Properties& properties) {
    std::vector<Point> points;
    std::vector<std::size_t> kept;
    if (auto read = positions(json, path, points, kept); !read) return read;
    if (json.size() < 4)
      return bad(path, "is a ring of " + std::to_string(json.size()) + " positions, it needs 4");
    if (points.front() != points.back())
      return bad(path, "is a ring that is not closed: it starts at " +
                           coordinates(points.front().x, points.front().y) + " and ends at " +
                           coordinates(points.back().x, points.back().y));
    if (points.size() > 1) points.pop_back();
    if (points.size() < 3) return bad(path, "is a ring with fewer than 3 distinct points");
    if (const auto crossing = find_crossing(points)) {
      const auto edge = [&](std::uint32_t i) {
        const Point a = points[i];
        const Point b = points[i + 1 < points.size() ? i + 1 : 0];
        return "edge " + std::to_string(kept[i]) + " from " + coordinates(a.x, a.y) + " to " +
               coordinates(b.x, b.y);
      };
      return bad(path, "is a ring that crosses itself: " + edge(crossing->first) + " crosses " +
                           edge(crossing->second));
    }
    return chain(points, kept, true, path, properties);
  }

  // Lines beside polygons are doubled, regions get their seeds.
  Result<Domain> finish() {
    std::vector<PolygonRange> ranges;
    for (const RegionPolygon& polygon : region_polygons_) ranges.push_back(polygon.range);
    const auto seeds = interior_points(domain_, ranges);
    if (!seeds) return bad("", seeds.error().message);
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const RegionPolygon& polygon = region_polygons_[i];
      if (!(*seeds)[i]) return bad(polygon.path, "is a polygon with a region but without area");
      domain_.region_places.add(i, name_ + ": the region of " + polygon.path + ", seed ", 0, "");
      domain_.regions.push_back(
          {*(*seeds)[i], polygon.properties.region.value_or(0), polygon.properties.max_area});
    }
    if (domain_.fill == Domain::Fill::kEvenOdd) {
      for (const Line& line : lines_) {
        domain_.segment_places.add(domain_.segments.size(),
                                   name_ + ": " + line.path + ", edge number ", 0, "");
        for (std::size_t s = line.first_segment; s < line.end_segment; ++s)
          domain_.segments.push_back(Domain::Segment(domain_.segments[s]));
      }
    }
    return std::move(domain_);
  }

  struct Line {
    std::size_t first_segment;
    std::size_t end_segment;
    std::string path;
  };

  std::string name_;
  Domain domain_;
  std::vector<Line> lines_;
  std::vector<RegionPolygon> region_polygons_;
};

}  // namespace

Result<Domain> read_geojson(const std::filesystem::path& path) {
  const auto contents = read_file(path, kMaxJsonBytes);
  if (!contents) return tl::unexpected(contents.error());
  try {
    const auto json = parse_json(path.string(), contents->text(), kMaxJsonDepth);
    if (!json) return tl::unexpected(json.error());
    return Reader(path.string()).read(*json);
  } catch (const std::bad_alloc&) {
    return fail(ExitCode::kUnreadableInput, path.string() + ": not enough memory to read it");
  }
}

}  // namespace weft::client
