// SPDX-License-Identifier: Apache-2.0
// The functions of GDAL that weft calls, from the shared library, which is loaded when it is first
// asked for and stays. Those that make or describe a coordinate system are thread-safe, those on
// one data set are not.
#pragma once

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <gdal_alg.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <string>

#include "files/base/error.h"
#include "loader/function_table.h"

#define WEFT_GDAL_FUNCTIONS(EACH)           \
  EACH(CPLGetConfigOption)                  \
  EACH(CPLGetErrorHandlerUserData)          \
  EACH(CPLPopErrorHandler)                  \
  EACH(CPLPushErrorHandlerEx)               \
  EACH(CPLSetConfigOption)                  \
  EACH(CSLDestroy)                          \
  EACH(GDALAllRegister)                     \
  EACH(GDALApproxTransform)                 \
  EACH(GDALClose)                           \
  EACH(GDALCreateApproxTransformer)         \
  EACH(GDALCreateReprojectionTransformerEx) \
  EACH(GDALDataTypeIsComplex)               \
  EACH(GDALDatasetGetLayer)                 \
  EACH(GDALDatasetGetLayerByName)           \
  EACH(GDALDatasetGetLayerCount)            \
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
  EACH(OGR_FD_GetFieldCount)                \
  EACH(OGR_FD_GetFieldDefn)                 \
  EACH(OGR_F_Destroy)                       \
  EACH(OGR_F_GetFID)                        \
  EACH(OGR_F_GetFieldAsDouble)              \
  EACH(OGR_F_GetFieldAsString)              \
  EACH(OGR_F_GetFieldDefnRef)               \
  EACH(OGR_F_GetFieldIndex)                 \
  EACH(OGR_F_GetGeometryRef)                \
  EACH(OGR_F_IsFieldSetAndNotNull)          \
  EACH(OGR_Fld_GetNameRef)                  \
  EACH(OGR_Fld_GetType)                     \
  EACH(OGR_GT_Flatten)                      \
  EACH(OGR_G_GetGeometryCount)              \
  EACH(OGR_G_GetGeometryName)               \
  EACH(OGR_G_GetGeometryRef)                \
  EACH(OGR_G_GetGeometryType)               \
  EACH(OGR_G_GetPointCount)                 \
  EACH(OGR_G_GetPoints)                     \
  EACH(OGR_G_IsEmpty)                       \
  EACH(OGR_L_FindFieldIndex)                \
  EACH(OGR_L_GetFeatureCount)               \
  EACH(OGR_L_GetLayerDefn)                  \
  EACH(OGR_L_GetName)                       \
  EACH(OGR_L_GetNextFeature)                \
  EACH(OGR_L_GetSpatialRef)                 \
  EACH(OGR_L_ResetReading)                  \
  EACH(OGR_L_SetAttributeFilter)            \
  EACH(OSRClone)                            \
  EACH(OSRDestroySpatialReference)          \
  EACH(OSRExportToWktEx)                    \
  EACH(OSRGetAngularUnits)                  \
  EACH(OSRGetName)                          \
  EACH(OSRIsGeographic)                     \
  EACH(OSRIsSame)                           \
  EACH(OSRNewSpatialReference)              \
  EACH(OSRSetAxisMappingStrategy)           \
  EACH(OSRSetFromUserInput)                 \
  EACH(VSIFree)                             \
  EACH(VSIIngestFile)                       \
  EACH(VSIReadDirRecursive)

namespace weft::files {

WEFT_FUNCTION_TABLE(Gdal, WEFT_GDAL_FUNCTIONS);

// Options of GDAL that would change what a file is read as have their defaults, whatever the
// environment and GDAL's files of options say. Errors (kUnreadableInput) name the library and why
// it is not loaded.
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
  bool any() const { return !first_.empty(); }

 private:
  static void CPL_STDCALL note(CPLErr level, CPLErrorNum number, const char* text);

  const Gdal& gdal_;
  std::string first_;
};

}  // namespace weft::files
