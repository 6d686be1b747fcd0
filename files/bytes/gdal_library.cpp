// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/gdal_library.h"

#include <cstdlib>

#include "files/base/text.h"

namespace weft::files {
namespace {

// Holds one or two rows of blocks of a wide raster.
constexpr GIntBig kCacheBytes = GIntBig{128} << 20;

// What GDAL takes from the environment, and its defaults. Without a default: an option that is not
// there. The same file is the same domain, and the same field, for everybody.
struct ConfigOption {
  const char* name;
  const char* value;
};
constexpr ConfigOption kOptions[] = {
    {"OGR_ARC_STEPSIZE", "4"},
    {"OGR_ARC_MAX_GAP", "0"},
    {"OGR_STROKE_CURVE", "FALSE"},
    {"OGR_ORGANIZE_POLYGONS", nullptr},
    {"GML_CONSIDER_EPSG_AS_URN", nullptr},
    {"GML_FACE_HOLE_NEGATIVE", nullptr},
    {"GML_FETCH_ALL_GEOMETRIES", nullptr},
    {"GML_GET_SECONDARY_GEOM", nullptr},
    {"GML_INVERT_AXIS_ORDER_IF_LAT_LONG", nullptr},
    {"GML_SKIP_CORRUPTED_FEATURES", nullptr},
    {"GML_SRS_DIMENSION_IF_MISSING", nullptr},
    {"GML_SWAP_COORDINATES", nullptr},
    {"LIBKML_READ_GROUND_OVERLAY", nullptr},
    {"LIBKML_WRAPDATELINE", nullptr},
    {"MITAB_BOUNDS_FILE", nullptr},
    {"OSR_DEFAULT_AXIS_MAPPING_STRATEGY", nullptr},
    {"OGR_CT_FORCE_TRADITIONAL_GIS_ORDER", nullptr},
    {"SHAPE_ENCODING", nullptr},
    {"GDAL_NETCDF_BOTTOMUP", nullptr},
    {"GDAL_NETCDF_CENTERLONG_180", nullptr},
    {"GTIFF_HONOUR_NEGATIVE_SCALEY", nullptr},
    {"GTIFF_POINT_GEO_IGNORE", nullptr},
};

void set_options(const Gdal& gdal) {
  for (const auto& [name, value] : kOptions) {
    if (value == nullptr) ::unsetenv(name);
    gdal.CPLSetConfigOption(name, value);
  }
}

Result<Gdal> load() {
  auto loaded = load_functions<Gdal>(WEFT_GDAL_SONAME);
  if (!loaded)
    return fail(ExitCode::kUnreadableInput, loaded.error() + "; weft reads it with GDAL");
  Gdal& gdal = *loaded;
  gdal.GDALAllRegister();  // reads files of options
  set_options(gdal);
  if (gdal.CPLGetConfigOption("GDAL_CACHEMAX", nullptr) == nullptr)
    gdal.GDALSetCacheMax64(kCacheBytes);
  return gdal;
}

}  // namespace

Result<const Gdal*> load_gdal() {
  static const Result<Gdal> loaded = load();
  if (!loaded) return tl::unexpected(loaded.error());
  return &*loaded;
}

GdalErrors::GdalErrors(const Gdal& gdal) : gdal_(gdal) {
  gdal_.CPLPushErrorHandlerEx(&GdalErrors::note, this);
}

GdalErrors::~GdalErrors() {
  gdal_.CPLPopErrorHandler();
}

void GdalErrors::note(CPLErr level, CPLErrorNum, const char* text) {
  const auto gdal = load_gdal();
  if (!gdal || level < CE_Failure) return;
  auto* self = static_cast<GdalErrors*>((*gdal)->CPLGetErrorHandlerUserData());
  if (self != nullptr && self->first_.empty()) self->first_ = text;
}

std::string GdalErrors::first() const {
  return first_.empty() ? "GDAL does not say why" : harmless(first_);
}

}  // namespace weft::files
