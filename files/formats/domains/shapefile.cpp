// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/shapefile.h"

#include <shapefil.h>

#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
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

// Opens a file; instead of an .shx file that is not there, one in memory.
SAFile open_or_make(const char* name, const char* access) {
  std::FILE* file = std::fopen(name, access);
  const std::filesystem::path path(name);
  if (file != nullptr || lower_extension(path) != ".shx") return reinterpret_cast<SAFile>(file);
  for (const char* extension : {".shp", ".SHP"}) {
    const auto shapes = read_file(std::filesystem::path(path).replace_extension(extension),
                                  std::numeric_limits<std::uint32_t>::max());
    const std::string index = shapes ? index_of_shapes(shapes->text()) : "";
    if (index.empty()) continue;
    file = ::fmemopen(nullptr, index.size() + 1, "w+b");  // a null byte follows
    if (file != nullptr) std::fwrite(index.data(), 1, index.size(), file);
    if (file != nullptr) std::rewind(file);
    break;
  }
  return reinterpret_cast<SAFile>(file);
}

// Opens files without Shapelib's own messages on stderr: the caller reports the error.
SAHooks quiet_hooks() {
  SAHooks hooks;
  ::SASetupDefaultHooks(&hooks);
  hooks.FOpen = open_or_make;
  hooks.Error = [](const char*) {};
  return hooks;
}

// The attributes of the records.
class Table {
 public:
  // An error if there is a table that cannot be read. It is no error if there is none.
  Result<void> open(const std::filesystem::path& path, const SAHooks& hooks,
                    const std::filesystem::path& text) {
    std::error_code ignored;
    for (const char* extension : {".dbf", ".DBF"}) {
      const auto name = std::filesystem::path(path).replace_extension(extension);
      if (!std::filesystem::exists(name, ignored)) continue;
      table_.reset(::DBFOpenLL(name.c_str(), "rb", const_cast<SAHooks*>(&hooks)));
      if (!table_)
        return fail(ExitCode::kUnreadableInput,
                    std::filesystem::path(text).replace_extension(extension).string() +
                        ": is not a dBASE table");
      return {};
    }
    return {};
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
  Reader(const std::filesystem::path& path, const SAHooks& hooks, bool lonlat,
         const std::string& name)
      : path_(path), name_(name), hooks_(hooks), builder_(name, lonlat) {}

  Result<Domain> read() {
    const std::unique_ptr<SHPInfo, CloseShapes> shapes(
        ::SHPOpenLL(path_.c_str(), "rb", const_cast<SAHooks*>(&hooks_)));
    if (!shapes)
      return builder_.bad("", "is not a shapefile, or it or the .shx beside it is damaged");
    if (auto opened = table_.open(path_, hooks_, name_); !opened)
      return tl::unexpected(opened.error());
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
  std::string name_;
  const SAHooks& hooks_;
  Table table_;
  GeometryBuilder builder_;
};

// The system in the .prj file, which is Esri's WKT.
std::optional<CoordinateSystem> system_beside(const std::filesystem::path& path) {
  constexpr std::uint64_t kMaxBytes = 1 << 16;
  std::error_code ignored;
  for (const char* extension : {".prj", ".PRJ"}) {
    const auto name = std::filesystem::path(path).replace_extension(extension);
    if (!std::filesystem::is_regular_file(name, ignored)) continue;
    const auto contents = read_text_file(name, kMaxBytes);
    if (!contents) continue;
    const std::string text(contents->text());
    const std::size_t from = text.find('"');
    const std::size_t to = text.find('"', from + 1);
    if (from == std::string::npos || to == std::string::npos) continue;
    return CoordinateSystem{harmless(text.substr(from + 1, to - from - 1)),
                            text.starts_with("GEOGCS"), text};
  }
  return std::nullopt;
}

}  // namespace

Result<Domain> read_shapefile(const std::filesystem::path& path, bool lonlat) {
  return read_shapefile(path, lonlat, path.string());
}

Result<Domain> read_shapefile(const std::filesystem::path& path, bool lonlat,
                              const std::string& name) {
  if (std::error_code missing; !std::filesystem::is_regular_file(path, missing))
    return fail(ExitCode::kUnreadableInput,
                path.string() + ": " + (missing ? missing.message() : "is not a regular file"));
  const SAHooks hooks = quiet_hooks();
  auto domain = Reader(path, hooks, lonlat, name).read();
  if (domain) domain->system = system_beside(path);
  return domain;
}

}  // namespace weft::files
