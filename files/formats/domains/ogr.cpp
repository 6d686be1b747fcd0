// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/ogr.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <vector>

#include "files/base/text.h"
#include "files/bytes/gdal_library.h"
#include "files/formats/domains/dxf.h"
#include "files/formats/domains/feature_properties.h"
#include "files/formats/domains/geometry_builder.h"
#include "files/formats/domains/ogr_archive.h"
#include "files/formats/domains/three_point_arcs.h"
#include "files/formats/mesh_formats.h"
#include "files/formats/triangle/triangle_points.h"

namespace weft::files {
namespace {

constexpr int kMaxDepth = 64;  // of geometries in geometries

using Dataset = std::unique_ptr<void, decltype(&GDALClose)>;
using Feature = std::unique_ptr<std::remove_pointer_t<OGRFeatureH>, decltype(&OGR_F_Destroy)>;
using Crs = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>,
                            decltype(&OSRDestroySpatialReference)>;

class Reader {
 public:
  Reader(const Gdal& gdal, const std::filesystem::path& path, bool lonlat)
      : gdal_(gdal), path_(path), builder_(path.string(), lonlat) {}

  Result<Domain> read(const DomainFormat& format, const LayerOptions& options) {
    // An absolute path cannot begin with a prefix that GDAL would interpret, such as "GPKG:".
    const std::string address = std::filesystem::absolute(path_).string();
    if (address.starts_with("/vsi"))
      return builder_.bad("", "is in a folder whose name GDAL takes for another file system");
    OgrSource source{address, &format};
    if (format.is_archive) {
      auto found = find_in_archive(gdal_, address);
      if (!found) return builder_.bad("", found.error().message);
      source = std::move(*found);
    }
    if (source.format->drivers == nullptr) return read_drawing(source.address, options);
    Dataset dataset(nullptr, gdal_.GDALClose);
    {
      const GdalErrors errors(gdal_);
      dataset = open(source.address, *source.format);
      if (!dataset) return builder_.bad("", "is damaged, or of another format: " + errors.first());
    }
    const auto layers = choose(dataset.get(), options.layers);
    if (!layers) return tl::unexpected(layers.error());
    attributes_ = &options.attributes;
    if (auto ok = check_attributes(*layers); !ok) return tl::unexpected(ok.error());
    for (OGRLayerH layer : *layers)
      if (auto added = add_layer(layer, options.where); !added)
        return tl::unexpected(added.error());
    auto domain = builder_.finish();
    if (domain && crs_ != nullptr) domain->system = system();
    return domain;
  }

 private:
  Dataset open(const std::string& address, const DomainFormat& format) const {
    return {
        gdal_.GDALOpenEx(address.c_str(), GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                         format.drivers, format.driver_options, nullptr),
        gdal_.GDALClose};
  }

  // Of an archive.
  Result<Domain> read_drawing(const std::string& address, const LayerOptions& options) const {
    const GdalErrors errors(gdal_);
    GByte* bytes = nullptr;
    vsi_l_offset size = 0;
    if (gdal_.VSIIngestFile(nullptr, address.c_str(), &bytes, &size, kMaxTextBytes) == 0)
      return builder_.bad("", "is damaged: " + errors.first());
    const std::unique_ptr<GByte, decltype(&VSIFree)> owner(bytes, gdal_.VSIFree);
    return read_dxf_text(path_.string(), {reinterpret_cast<const char*>(bytes), size}, options);
  }

  CoordinateSystem system() const {
    const char* name = gdal_.OSRGetName(crs_);
    CoordinateSystem found{
        harmless(name != nullptr && *name != '\0' ? name : "an unnamed coordinate system"),
        gdal_.OSRIsGeographic(crs_) != 0, ""};
    const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
    char* text = nullptr;
    if (gdal_.OSRExportToWktEx(crs_, &text, options) == OGRERR_NONE) found.definition = text;
    gdal_.VSIFree(text);
    return found;
  }

  std::string name_of(OGRLayerH layer) const { return gdal_.OGR_L_GetName(layer); }

  std::string list(const std::vector<OGRLayerH>& layers) const {
    std::vector<std::string> names;
    for (OGRLayerH layer : layers) names.push_back(name_of(layer));
    return in_quotes(names);
  }

  // The layers that are named, or the only one that has a feature.
  Result<std::vector<OGRLayerH>> choose(GDALDatasetH dataset,
                                        const std::vector<std::string>& names) const {
    const GdalErrors quiet(gdal_);
    std::vector<OGRLayerH> all;
    for (int i = 0; i < gdal_.GDALDatasetGetLayerCount(dataset); ++i)
      all.push_back(gdal_.GDALDatasetGetLayer(dataset, i));
    std::vector<OGRLayerH> chosen;
    for (const std::string& name : names) {
      OGRLayerH layer = gdal_.GDALDatasetGetLayerByName(dataset, name.c_str());
      if (layer == nullptr)
        return builder_.bad("", "has no layer " + in_quotes(name) + "; there are " + list(all));
      chosen.push_back(layer);
    }
    if (!names.empty() || all.size() == 1) return names.empty() ? all : chosen;
    for (OGRLayerH layer : all)
      if (gdal_.OGR_L_GetFeatureCount(layer, TRUE) != 0) chosen.push_back(layer);
    if (chosen.size() > 1)
      return builder_.bad("", "has " + std::to_string(chosen.size()) +
                                  " layers; name those that are meant by --layer; there are " +
                                  list(chosen));
    return chosen;
  }

  // Each attribute is in one of the layers.
  Result<void> check_attributes(const std::vector<OGRLayerH>& layers) const {
    for (const auto& [property, attribute] : *attributes_) {
      const auto has_it = [this, name = attribute.c_str()](OGRLayerH layer) {
        return gdal_.OGR_L_FindFieldIndex(layer, name, TRUE) >= 0;
      };
      if (std::ranges::any_of(layers, has_it)) continue;
      std::vector<std::string> names;
      for (OGRLayerH layer : layers) {
        OGRFeatureDefnH features = gdal_.OGR_L_GetLayerDefn(layer);
        for (int i = 0; i < gdal_.OGR_FD_GetFieldCount(features); ++i)
          names.emplace_back(gdal_.OGR_Fld_GetNameRef(gdal_.OGR_FD_GetFieldDefn(features, i)));
      }
      return builder_.bad("", "has no attribute " + in_quotes(attribute) +
                                  (names.empty() ? "" : "; there are " + in_quotes(names)));
    }
    return {};
  }

  Result<void> add_layer(OGRLayerH layer, const std::string& where) {
    const std::string name = "layer " + in_quotes(name_of(layer));
    if (auto ok = check_system(layer, name); !ok) return ok;
    return for_each_feature(layer, where, [this](OGRFeatureH feature, const std::string& of_layer) {
      return add_feature(feature,
                         of_layer + ", feature " + std::to_string(gdal_.OGR_F_GetFID(feature)));
    });
  }

  // Calls `each` with the features of a layer that meet the condition.
  template <class Each>
  Result<void> for_each_feature(OGRLayerH layer, const std::string& where, const Each& each) {
    const std::string name = "layer " + in_quotes(name_of(layer));
    const auto unreadable = [&](const GdalErrors& errors) {
      return builder_.bad(name + (where.empty() ? "" : ", --where " + in_quotes(where)),
                          "cannot be read: " + errors.first());
    };
    const GdalErrors errors(gdal_);
    if (!where.empty() && gdal_.OGR_L_SetAttributeFilter(layer, where.c_str()) != OGRERR_NONE)
      return unreadable(errors);
    gdal_.OGR_L_ResetReading(layer);
    const GdalErrors reading(gdal_);
    for (;;) {
      const Feature feature(gdal_.OGR_L_GetNextFeature(layer), gdal_.OGR_F_Destroy);
      if (!feature) break;
      if (Result<void> done = each(feature.get(), name); !done) return done;
    }
    if (reading.any()) return unreadable(reading);
    return {};
  }

  // All layers have one coordinate system.
  Result<void> check_system(OGRLayerH layer, const std::string& name) {
    const GdalErrors quiet(gdal_);
    OGRSpatialReferenceH crs = gdal_.OGR_L_GetSpatialRef(layer);
    const bool same =
        crs == nullptr || crs_ == nullptr ? crs == crs_ : gdal_.OSRIsSame(crs, crs_) != 0;
    if (!first_ && !same)
      return builder_.bad(name, "has another coordinate system than the layer before it");
    first_ = false;
    crs_ = crs;
    return {};
  }

  Result<void> add_feature(OGRFeatureH feature, const std::string& path) {
    OGRGeometryH geometry = gdal_.OGR_F_GetGeometryRef(feature);
    if (geometry == nullptr) return {};
    const auto properties = read_properties(feature, path);
    if (!properties) return tl::unexpected(properties.error());
    return add_geometry(geometry, path, *properties, 0);
  }

  PropertyValue value(OGRFeatureH feature, const char* property) const {
    const auto named = attributes_->find(property);
    const char* const attribute = named == attributes_->end() ? property : named->second.c_str();
    const int index = gdal_.OGR_F_GetFieldIndex(feature, attribute);
    if (index < 0 || gdal_.OGR_F_IsFieldSetAndNotNull(feature, index) == 0) return {};
    const auto type = gdal_.OGR_Fld_GetType(gdal_.OGR_F_GetFieldDefnRef(feature, index));
    const std::string text = gdal_.OGR_F_GetFieldAsString(feature, index);
    if (type == OFTString) return {std::nullopt, text, ""};
    const bool is_number = type == OFTInteger || type == OFTInteger64 || type == OFTReal;
    const double number = is_number ? gdal_.OGR_F_GetFieldAsDouble(feature, index) : 0;
    if (is_number && std::isfinite(number)) return number_of_table(property, number);
    return {std::nullopt, "", in_quotes(text)};
  }

  Result<GeometryProperties> read_properties(OGRFeatureH feature, const std::string& path) {
    return feature_properties(builder_, path + ", field ",
                              [&](const char* name) { return value(feature, name); });
  }

  std::vector<Point> points_of(OGRGeometryH line) const {
    const int count = gdal_.OGR_G_GetPointCount(line);
    std::vector<Point> points(static_cast<std::size_t>(count));
    if (count > 0)
      gdal_.OGR_G_GetPoints(line, &points[0].x, sizeof(Point), &points[0].y, sizeof(Point), nullptr,
                            0);
    return points;
  }

  // A line, a circular string, or a compound curve of these.
  Result<ArcChain> chain_of(OGRGeometryH curve, const std::string& path) const {
    ArcChain chain;
    std::string fault;
    switch (gdal_.OGR_GT_Flatten(gdal_.OGR_G_GetGeometryType(curve))) {
      case wkbCircularString:
        if (gdal_.OGR_G_IsEmpty(curve) == 0) fault = add_three_point_arcs(points_of(curve), chain);
        break;
      case wkbCompoundCurve:
        for (int i = 0; i < gdal_.OGR_G_GetGeometryCount(curve) && fault.empty(); ++i) {
          const auto part = chain_of(gdal_.OGR_G_GetGeometryRef(curve, i), path);
          if (!part) return part;
          fault = append(*part, chain);
        }
        break;
      default:
        chain = ArcChain(points_of(curve));
    }
    if (!fault.empty()) return builder_.bad(path, fault);
    return chain;
  }

  Result<void> add_line(OGRGeometryH line, const std::string& path,
                        const GeometryProperties& properties) {
    const auto chain = chain_of(line, path);
    if (!chain) return tl::unexpected(chain.error());
    return builder_.line(chain->points, path, properties, {}, chain->bulges);
  }
  Result<void> add_polygon(OGRGeometryH polygon, const std::string& path,
                           const GeometryProperties& properties) {
    builder_.begin_polygon();
    for (int i = 0; i < gdal_.OGR_G_GetGeometryCount(polygon); ++i) {
      const std::string ring = path + ", ring " + std::to_string(i);
      const auto chain = chain_of(gdal_.OGR_G_GetGeometryRef(polygon, i), ring);
      if (!chain) return tl::unexpected(chain.error());
      if (auto added = builder_.ring(chain->points, ring, properties, {}, chain->bulges); !added)
        return added;
    }
    builder_.end_polygon(path, properties);
    return {};
  }

  Result<void> add_geometry(OGRGeometryH geometry, const std::string& path,
                            const GeometryProperties& properties, int depth) {
    if (depth > kMaxDepth)
      return builder_.bad(path, "is nested deeper than " + std::to_string(kMaxDepth) + " levels");
    if (gdal_.OGR_G_IsEmpty(geometry) != 0) {
      builder_.leave_out(LeftOut::kGeometry, path);
      return {};
    }
    const int parts = gdal_.OGR_G_GetGeometryCount(geometry);
    switch (gdal_.OGR_GT_Flatten(gdal_.OGR_G_GetGeometryType(geometry))) {
      case wkbPoint:
        return builder_.point(points_of(geometry).at(0), path);
      case wkbLineString:
      case wkbCircularString:
      case wkbCompoundCurve:
        return add_line(geometry, path, properties);
      case wkbPolygon:
      case wkbTriangle:
      case wkbCurvePolygon:
        return add_polygon(geometry, path, properties);
      case wkbMultiPoint:
      case wkbMultiLineString:
      case wkbMultiPolygon:
      case wkbMultiCurve:
      case wkbMultiSurface:
      case wkbGeometryCollection:
      case wkbPolyhedralSurface:
      case wkbTIN:
        for (int i = 0; i < parts; ++i)
          if (auto added =
                  add_geometry(gdal_.OGR_G_GetGeometryRef(geometry, i),
                               path + ", part " + std::to_string(i), properties, depth + 1);
              !added)
            return added;
        return {};
      default:
        return builder_.bad(path, "is a " + harmless(gdal_.OGR_G_GetGeometryName(geometry)) +
                                      ", which is no polygon, line or point");
    }
  }

  const Gdal& gdal_;
  const std::filesystem::path& path_;
  GeometryBuilder builder_;
  const std::map<std::string, std::string>* attributes_ = nullptr;  // as in LayerOptions
  bool first_ = true;                                               // no layer was read yet
  OGRSpatialReferenceH crs_ = nullptr;                              // of the layers, which own it
};

}  // namespace

Result<Domain> read_with_ogr(const DomainFormat& format, const std::filesystem::path& path,
                             const LayerOptions& options) {
  if (std::error_code missing; !std::filesystem::is_regular_file(path, missing))
    return fail(ExitCode::kUnreadableInput,
                path.string() + ": " + (missing ? missing.message() : "is not a regular file"));
  const auto gdal = load_gdal();
  if (!gdal) return fail(gdal.error().exit, path.string() + ": " + gdal.error().message);
  auto domain = Reader(**gdal, path, options.lonlat).read(format, options);
  // MicroStation's shapes have no holes: a shape inside another one stands for a hole.
  if (domain && !domain->areas.empty() && format.extension == ".dgn")
    domain->fill = Domain::Fill::kEvenOdd;
  return domain;
}

bool are_same(const CoordinateSystem& a, const CoordinateSystem& b) {
  if ((a.geographic && b.geographic) || a.definition == b.definition) return true;
  const auto gdal = load_gdal();
  if (!gdal) return false;
  const GdalErrors quiet(**gdal);
  const auto made = [&](const CoordinateSystem& system) {
    Crs crs((*gdal)->OSRNewSpatialReference(nullptr), (*gdal)->OSRDestroySpatialReference);
    if ((*gdal)->OSRSetFromUserInput(crs.get(), system.definition.c_str()) != OGRERR_NONE)
      crs.reset();
    return crs;
  };
  const Crs first = made(a);
  const Crs second = made(b);
  return first && second && (*gdal)->OSRIsSame(first.get(), second.get()) != 0;
}

}  // namespace weft::files
