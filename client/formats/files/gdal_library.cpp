// SPDX-License-Identifier: Apache-2.0
#include "client/formats/files/gdal_library.h"

#include "client/base/text.h"

namespace weft::client {
namespace {

// Holds one or two rows of blocks of a wide raster.
constexpr GIntBig kCacheBytes = GIntBig{128} << 20;

Result<Gdal> load() {
  auto loaded = load_functions<Gdal>(WEFT_GDAL_SONAME);
  if (!loaded)
    return fail(ExitCode::kUnreadableInput, loaded.error() + "; weft reads it with GDAL");
  Gdal& gdal = *loaded;
  gdal.GDALAllRegister();
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

}  // namespace weft::client
