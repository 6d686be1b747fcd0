// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/shapefile.h"

#include <shapefil.h>

#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/code_page.h"
#include "files/bytes/file_contents.h"
#include "files/bytes/shapefile_index.h"
#include "files/formats/domains/feature_properties.h"
#include "files/formats/domains/geometry_builder.h"
#include "files/formats/mesh_formats.h"

namespace weft::files {
namespace {

struct CloseShapes {
  void operator()(SHPInfo* shapes) const { ::SHPClose(shapes); }
};
struct CloseTable {
  void operator()(DBFInfo* table) const { ::DBFClose(table); }
};
struct DestroyShape {
  void operator()(SHPObject* shape) const { ::SHPDestroyObject(shape); }
};

// What this thread reads, because Shapelib's hooks are told nothing but a name.
thread_local const ShapefileParts* reading = nullptr;

SAFile open_part(const char* name, const char*) {
  const auto part = reading->find(std::filesystem::path(name).extension().string());
  if (part == reading->end()) return nullptr;
  const std::string& bytes = part->second;
  return reinterpret_cast<SAFile>(
      ::fmemopen(const_cast<char*>(bytes.data()), bytes.size(), "rb"));  // only reads
}

// Opens parts without Shapelib's own messages on stderr: the caller reports the error.
SAHooks quiet_hooks() {
  SAHooks hooks;
  ::SASetupDefaultHooks(&hooks);
  hooks.FOpen = open_part;
  hooks.Error = [](const char*) {};
  return hooks;
}

// The attributes of the records.
class Table {
 public:
  // An error if there is a table that cannot be read. It is no error if there is none.
  Result<void> open(const SAHooks& hooks, const std::filesystem::path& shapes) {
    if (!reading->contains(".dbf")) return {};
    table_.reset(::DBFOpenLL("part.dbf", "rb", const_cast<SAHooks*>(&hooks)));
    if (table_) return {};
    return fail(ExitCode::kUnreadableInput,
                std::filesystem::path(shapes).replace_extension(".dbf").string() +
                    ": is not a dBASE table");
  }

  PropertyValue value(int record, const std::string& field) const {
    if (!table_ || record >= ::DBFGetRecordCount(table_.get())) return {};
    const int index = ::DBFGetFieldIndex(table_.get(), field.c_str());
    if (index < 0 || ::DBFIsAttributeNULL(table_.get(), record, index) != 0) return {};
    const DBFFieldType type = ::DBFGetFieldInfo(table_.get(), index, nullptr, nullptr, nullptr);
    if (type == FTInteger || type == FTDouble)
      return number_of_table(field, ::DBFReadDoubleAttribute(table_.get(), record, index));
    const char* const read = ::DBFReadStringAttribute(table_.get(), record, index);
    const char* const page = ::DBFGetCodePage(table_.get());
    const std::string text = to_utf8(read != nullptr ? read : "", page != nullptr ? page : "");
    if (type != FTString) return {std::nullopt, "", in_quotes(text)};
    return {std::nullopt, text, ""};
  }

 private:
  std::unique_ptr<DBFInfo, CloseTable> table_;
};

class Reader {
 public:
  Reader(const std::filesystem::path& path, const SAHooks& hooks, bool lonlat)
      : path_(path), hooks_(hooks), builder_(path.string(), lonlat) {}

  Result<Domain> read() {
    const std::unique_ptr<SHPInfo, CloseShapes> shapes(
        ::SHPOpenLL("part.shp", "rb", const_cast<SAHooks*>(&hooks_)));
    if (!shapes)
      return builder_.bad("", "is not a shapefile, or it or the .shx beside it is damaged");
    if (auto opened = table_.open(hooks_, path_); !opened) return tl::unexpected(opened.error());
    int count = 0;
    int kind = 0;
    ::SHPGetInfo(shapes.get(), &count, &kind, nullptr, nullptr);
    for (int i = 0; i < count; ++i) {
      const std::unique_ptr<SHPObject, DestroyShape> shape(::SHPReadObject(shapes.get(), i));
      const std::string path = "record " + std::to_string(i);
      if (!shape) return builder_.bad(path, "is damaged");
      const auto properties = read_properties(i, path);
      if (!properties) return tl::unexpected(properties.error());
      if (auto added = add(*shape, path, *properties); !added) return tl::unexpected(added.error());
    }
    return builder_.finish();
  }

 private:
  Result<GeometryProperties> read_properties(int record, const std::string& path) {
    constexpr std::size_t kLongestName = 10;  // of a field, in the format
    return feature_properties(builder_, path + ", field ", [&](const char* name) {
      return table_.value(record, std::string(name).substr(0, kLongestName));
    });
  }

  // The points of a part; empty for one that the record does not hold.
  static std::vector<Point> part(const SHPObject& shape, int i) {
    const int first = shape.panPartStart[i];
    const int end = i + 1 < shape.nParts ? shape.panPartStart[i + 1] : shape.nVertices;
    std::vector<Point> points;
    for (int v = first; v >= 0 && v < end && v < shape.nVertices; ++v)
      points.push_back({shape.padfX[v], shape.padfY[v]});
    return points;
  }

  Result<void> add(const SHPObject& shape, const std::string& path,
                   const GeometryProperties& properties) {
    switch (shape.nSHPType) {
      case SHPT_NULL:
        return {};
      case SHPT_POINT:
      case SHPT_POINTZ:
      case SHPT_POINTM:
      case SHPT_MULTIPOINT:
      case SHPT_MULTIPOINTZ:
      case SHPT_MULTIPOINTM:
        for (int v = 0; v < shape.nVertices; ++v)
          if (auto added = builder_.point({shape.padfX[v], shape.padfY[v]},
                                          path + ", position " + std::to_string(v));
              !added)
            return added;
        return {};
      case SHPT_ARC:
      case SHPT_ARCZ:
      case SHPT_ARCM:
        for (int i = 0; i < shape.nParts; ++i)
          if (auto added =
                  builder_.line(part(shape, i), path + ", line " + std::to_string(i), properties);
              !added)
            return added;
        return {};
      case SHPT_POLYGON:
      case SHPT_POLYGONZ:
      case SHPT_POLYGONM:
        builder_.begin_polygon(RingRoles::kByDirection);
        for (int i = 0; i < shape.nParts; ++i)
          if (auto added =
                  builder_.ring(part(shape, i), path + ", ring " + std::to_string(i), properties);
              !added)
            return added;
        builder_.end_polygon(path, properties);
        return {};
      default:
        return builder_.bad(path, "has the type " + std::to_string(shape.nSHPType) +
                                      ", which is no polygon, polyline, point or multipoint");
    }
  }

  std::filesystem::path path_;
  const SAHooks& hooks_;
  Table table_;
  GeometryBuilder builder_;
};

// The system in the .prj file, which is Esri's WKT.
std::optional<CoordinateSystem> system_in(const ShapefileParts& parts) {
  constexpr std::size_t kMaxBytes = 1 << 16;
  const auto part = parts.find(".prj");
  if (part == parts.end() || part->second.size() > kMaxBytes) return std::nullopt;
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  const std::string text = part->second.substr(part->second.starts_with(kMark) ? kMark.size() : 0);
  const std::size_t from = text.find('"');
  const std::size_t to = text.find('"', from + 1);
  if (from == std::string::npos || to == std::string::npos) return std::nullopt;
  return CoordinateSystem{harmless(text.substr(from + 1, to - from - 1)),
                          text.starts_with("GEOGCS"), text};
}

}  // namespace

Result<Domain> read_shapefile(const std::filesystem::path& path, bool lonlat) {
  std::error_code missing;
  if (!std::filesystem::is_regular_file(path, missing))
    return fail(ExitCode::kUnreadableInput,
                path.string() + ": " + (missing ? missing.message() : "is not a regular file"));
  ShapefileParts parts;
  const auto read = [&parts](const std::filesystem::path& name, const char* extension) {
    auto contents = read_file(name, std::numeric_limits<std::uint32_t>::max());
    if (contents) parts[extension] = contents->text();
    return contents;
  };
  if (const auto shapes = read(path, ".shp"); !shapes) return tl::unexpected(shapes.error());
  for (const auto& [extension, capitals] :
       {std::pair(".shx", ".SHX"), {".dbf", ".DBF"}, {".cpg", ".CPG"}, {".prj", ".PRJ"}})
    for (const char* each : {extension, capitals}) {
      const auto name = std::filesystem::path(path).replace_extension(each);
      if (!std::filesystem::exists(name, missing)) continue;
      if (const auto part = read(name, extension); !part) return tl::unexpected(part.error());
      break;
    }
  return read_shapefile(std::move(parts), path, lonlat);
}

Result<Domain> read_shapefile(ShapefileParts parts, const std::filesystem::path& path,
                              bool lonlat) {
  if (!parts.contains(".shx")) parts[".shx"] = index_of_shapes(parts.at(".shp"));
  reading = &parts;
  const SAHooks hooks = quiet_hooks();
  auto domain = Reader(path, hooks, lonlat).read();
  reading = nullptr;
  if (domain) domain->system = system_in(parts);
  return domain;
}

}  // namespace weft::files
