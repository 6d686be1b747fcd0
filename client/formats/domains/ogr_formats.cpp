// SPDX-License-Identifier: Apache-2.0
#include "client/formats/domains/ogr_formats.h"

#include <algorithm>

namespace weft::client {
namespace {

constexpr const char* kDgn[] = {"DGN", nullptr};
constexpr const char* kDxf[] = {"DXF", nullptr};
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

constexpr OgrFormat kFormats[] = {
    {".gpkg", kGeoPackage},
    {".fgb", kFlatGeobuf},
    {".kml", kKml},
    {".kmz", kKmz},
    {".gml", kGml, kGmlAlone},
    {".dxf", kDxf},
    {".dgn", kDgn},
    {".tab", kMapInfo},
    {".mif", kMapInfo},
    {".gmt", kGmt},
    {".geojsonl", kGeoJsonSequence},
    {".topojson", kTopoJson},
    {.extension = ".zip", .drivers = nullptr, .is_archive = true},
    {".shp", kShapefile, nullptr, true},
    {".geojson", kGeoJson, nullptr, true},
    {".json", kGeoJson, nullptr, true},
};

}  // namespace

std::span<const OgrFormat> ogr_formats() {
  return kFormats;
}

const OgrFormat* ogr_format(std::string_view extension) {
  const auto* const found =
      std::find_if(std::begin(kFormats), std::end(kFormats),
                   [extension](const OgrFormat& f) { return f.extension == extension; });
  return found == std::end(kFormats) ? nullptr : found;
}

}  // namespace weft::client
