// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domain_formats.h"

#include <algorithm>
#include <new>
#include <stdexcept>
#include <string_view>

#include "files/base/text.h"
#include "files/formats/derived/mesh_domain.h"
#include "files/formats/domains/csv_rings.h"
#include "files/formats/domains/dxf.h"
#include "files/formats/domains/femm.h"
#include "files/formats/domains/geojson.h"
#include "files/formats/domains/in2d.h"
#include "files/formats/domains/ogr.h"
#include "files/formats/domains/shapefile.h"
#include "files/formats/domains/wkt.h"
#include "files/formats/domains/zipped_shapefile.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/triangle/triangle_poly.h"

namespace weft::files {
namespace {

constexpr const char* kDgn[] = {"DGN", nullptr};
constexpr const char* kFlatGeobuf[] = {"FlatGeobuf", nullptr};
constexpr const char* kGeoJson[] = {"GeoJSON", nullptr};
constexpr const char* kGeoJsonSequence[] = {"GeoJSONSeq", "GeoJSON", nullptr};  // of one line
constexpr const char* kGeoPackage[] = {"GPKG", nullptr};
constexpr const char* kGml[] = {"GML", nullptr};
constexpr const char* kGmt[] = {"OGR_GMT", nullptr};
constexpr const char* kKml[] = {"LIBKML", "KML", nullptr};
constexpr const char* kKmz[] = {"LIBKML", nullptr};
constexpr const char* kMapInfo[] = {"MapInfo File", nullptr};
constexpr const char* kShapefile[] = {"ESRI Shapefile", nullptr};
constexpr const char* kTopoJson[] = {"TopoJSON", nullptr};

// A GML file may name an address for its schema, and GDAL would write what it learned to a file
// beside it.
constexpr const char* kGmlAlone[] = {"DOWNLOAD_SCHEMA=NO", "WRITE_GFS=NO", nullptr};

// Its segments are no rings.
Result<Domain> read_poly(const std::filesystem::path& path, bool) {
  return read_triangle_poly(path);
}

template <FemmProblem kProblem>
Result<Domain> read_model(const std::filesystem::path& path, bool) {
  return read_femm(path, kProblem);
}

// As messages list them.
constexpr DomainFormat kFormats[] = {
    {.extension = ".poly", .read = read_poly},
    {.extension = ".geojson", .read = read_geojson, .drivers = kGeoJson},
    {.extension = ".json", .read = read_geojson, .drivers = kGeoJson},
    {.extension = ".wkt", .read = read_wkt},
    {.extension = ".shp", .read = read_shapefile, .drivers = kShapefile, .needs_name = true},
    {.extension = ".csv", .read = read_csv_rings},
    {.extension = ".gpkg", .drivers = kGeoPackage, .needs_name = true},
    {.extension = ".fgb", .drivers = kFlatGeobuf},
    {.extension = ".kml", .drivers = kKml},
    {.extension = ".kmz", .drivers = kKmz, .needs_name = true},
    {.extension = ".gml", .drivers = kGml, .driver_options = kGmlAlone},
    {.extension = ".dxf", .read_layers = read_dxf},
    {.extension = ".in2d", .read = read_in2d},
    {.extension = ".fem", .read = read_model<FemmProblem::kMagnetics>},
    {.extension = ".fee", .read = read_model<FemmProblem::kElectrostatics>},
    {.extension = ".feh", .read = read_model<FemmProblem::kHeatFlow>},
    {.extension = ".fec", .read = read_model<FemmProblem::kCurrents>},
    {.extension = ".dgn", .drivers = kDgn},
    {.extension = ".tab", .drivers = kMapInfo, .needs_name = true},
    {.extension = ".mif", .drivers = kMapInfo, .needs_name = true},
    {.extension = ".gmt", .drivers = kGmt},
    {.extension = ".geojsonl", .drivers = kGeoJsonSequence},
    {.extension = ".topojson", .drivers = kTopoJson},
    {.extension = ".zip", .is_archive = true, .read_archived = read_zipped_shapefile},
};

// Of the formats that `takes` takes.
std::string extensions(bool (*takes)(const DomainFormat&)) {
  std::string list;
  for (const DomainFormat& format : kFormats)
    if (takes(format)) list += (list.empty() ? "" : ", ") + std::string(format.extension);
  return list;
}

bool is_read_as_mesh(const DataPath& path) {
  const MeshFormat* format = mesh_format(path);
  return format != nullptr && format->read != nullptr;
}

}  // namespace

const DomainFormat* domain_format(const DataPath& path) {
  const auto* const found =
      std::ranges::find(kFormats, lower_extension(path), &DomainFormat::extension);
  return found == std::end(kFormats) ? nullptr : found;
}

bool is_plain_domain_path(const DataPath& path) {
  return domain_format(path) != nullptr;
}

bool is_domain_path(const DataPath& path) {
  return is_plain_domain_path(path) || is_read_as_mesh(path);
}

std::string domain_extensions() {
  return extensions([](const DomainFormat&) { return true; });
}

tl::unexpected<Error> unknown_domain_format(const DataPath& path) {
  return fail(ExitCode::kUsage,
              path.string() + ": the extension " + in_quotes(extension_of(path)) +
                  " is not that of a domain: " + domain_extensions() +
                  "; nor of a mesh that is read as one: " + read_mesh_extensions());
}

namespace {

Result<Domain> read_mesh_as_domain(const DataPath& path) {
  const auto mesh = read_mesh(path);
  if (!mesh) return tl::unexpected(mesh.error());
  Domain domain = domain_of_mesh(path.string(), mesh->view());
  domain.warnings.insert(domain.warnings.begin(), mesh->warnings.begin(), mesh->warnings.end());
  return domain;
}

Result<Domain> read_any(const DataPath& path, const LayerOptions& layers) {
  const DomainFormat* const format = domain_format(path);
  if (format == nullptr && !is_read_as_mesh(path)) return unknown_domain_format(path);
  if (layers.wanted() && (format == nullptr || !format->has_layers()))
    return fail(ExitCode::kUsage,
                path.string() +
                    ": --layer, --where and --attribute are for files with layers and "
                    "attributes: " +
                    extensions([](const DomainFormat& f) { return f.has_layers(); }));
  try {
    if (format == nullptr) return read_mesh_as_domain(path);
    if (format->read_layers != nullptr) return format->read_layers(path, layers);
    if (format->read == nullptr || layers.wanted()) return read_with_ogr(*format, path, layers);
    return format->read(path, layers.lonlat);
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return fail(ExitCode::kUnreadableInput, path.string() + ": not enough memory to read it");
}

}  // namespace

Result<Domain> read_domain(const DataPath& path, const LayerOptions& layers) {
  auto domain = read_any(path, layers);
  if (!domain || !layers.strict || domain->warnings.empty()) return domain;
  std::string message = path.string() + ": refused, because of --strict";
  for (const Warning& warning : domain->warnings) message += "\n  " + warning.sentence();
  return fail(ExitCode::kUnreadableInput, message);
}

Result<Domain> read_own_domain(const DataPath& path, const LayerOptions& layers) {
  const DomainFormat* const format = domain_format(path);
  if (format == nullptr || !format->is_own() || layers.wanted())
    return fail(ExitCode::kUsage,
                in_quotes(extension_of(path)) +
                    " is not a format that is read here: " + own_domain_extensions());
  if (format->read_archived != nullptr) return format->read_archived(path, layers.lonlat);
  return read_domain(path, layers);
}

std::string own_domain_extensions() {
  return extensions([](const DomainFormat& format) { return format.is_own(); });
}

}  // namespace weft::files
