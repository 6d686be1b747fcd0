// SPDX-License-Identifier: Apache-2.0
// The functions of GDAL that weft calls, from the shared library, which is loaded when it is first
// asked for and stays. Those that make or describe a coordinate system are thread-safe, those on
// one data set are not.
#pragma once

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal.h>
#include <gdal_alg.h>
#include <ogr_srs_api.h>

#include <string>

#include "client/base/error.h"

#define WEFT_GDAL_FUNCTIONS(EACH)           \
  EACH(CPLGetConfigOption)                  \
  EACH(CPLGetErrorHandlerUserData)          \
  EACH(CPLPopErrorHandler)                  \
  EACH(CPLPushErrorHandlerEx)               \
  EACH(GDALAllRegister)                     \
  EACH(GDALApproxTransform)                 \
  EACH(GDALClose)                           \
  EACH(GDALCreateApproxTransformer)         \
  EACH(GDALCreateReprojectionTransformerEx) \
  EACH(GDALDataTypeIsComplex)               \
  EACH(GDALDestroyApproxTransformer)        \
  EACH(GDALDestroyReprojectionTransformer)  \
  EACH(GDALGetDescription)                  \
  EACH(GDALGetGeoTransform)                 \
  EACH(GDALGetMaskBand)                     \
  EACH(GDALGetMaskFlags)                    \
  EACH(GDALGetMetadata)                     \
  EACH(GDALGetMetadataItem)                 \
  EACH(GDALGetOverview)                     \
  EACH(GDALGetOverviewCount)                \
  EACH(GDALGetRasterBand)                   \
  EACH(GDALGetRasterBandXSize)              \
  EACH(GDALGetRasterBandYSize)              \
  EACH(GDALGetRasterColorInterpretation)    \
  EACH(GDALGetRasterCount)                  \
  EACH(GDALGetRasterDataType)               \
  EACH(GDALGetRasterOffset)                 \
  EACH(GDALGetRasterScale)                  \
  EACH(GDALGetSpatialRef)                   \
  EACH(GDALOpenEx)                          \
  EACH(GDALRasterIO)                        \
  EACH(GDALReprojectionTransform)           \
  EACH(GDALSetCacheMax64)                   \
  EACH(OSRClone)                            \
  EACH(OSRDestroySpatialReference)          \
  EACH(OSRGetAngularUnits)                  \
  EACH(OSRGetName)                          \
  EACH(OSRIsGeographic)                     \
  EACH(OSRNewSpatialReference)              \
  EACH(OSRSetAxisMappingStrategy)           \
  EACH(OSRSetFromUserInput)

namespace weft::client {

struct Gdal {
#define WEFT_GDAL_MEMBER(name) decltype(&::name) name = nullptr;
  WEFT_GDAL_FUNCTIONS(WEFT_GDAL_MEMBER)
#undef WEFT_GDAL_MEMBER
};

// Errors (kUnreadableInput) name the library and why it is not loaded.
Result<const Gdal*> load_gdal();

// As long as it lives, GDAL prints nothing on this thread.
class GdalErrors {
 public:
  explicit GdalErrors(const Gdal& gdal);
  ~GdalErrors();
  GdalErrors(const GdalErrors&) = delete;
  GdalErrors& operator=(const GdalErrors&) = delete;

  // What it would have printed: the first failure, safe for a terminal.
  std::string first() const;

 private:
  static void CPL_STDCALL note(CPLErr level, CPLErrorNum number, const char* text);

  const Gdal& gdal_;
  std::string first_;
};

}  // namespace weft::client
