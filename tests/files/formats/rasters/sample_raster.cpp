// SPDX-License-Identifier: Apache-2.0
#include "tests/files/formats/rasters/sample_raster.h"

#include <cpl_string.h>
#include <gtest/gtest.h>
#include <ogr_srs_api.h>

#include <cmath>

namespace weft::files {

void write_raster(const std::filesystem::path& path, const char* driver,
                  const SampleRaster& sample) {
  GDALAllRegister();
  // A mask belongs into the file.
  CPLSetConfigOption("GDAL_TIFF_INTERNAL_MASK", "YES");
  GDALDatasetH memory = GDALCreate(GDALGetDriverByName("MEM"), "", sample.columns, sample.rows,
                                   static_cast<int>(sample.bands.size()), sample.type, nullptr);
  ASSERT_NE(memory, nullptr);
  std::array<double, 6> t = {0, 1, 0, static_cast<double>(sample.rows), 0, -1};
  if (sample.transform) {
    t = *sample.transform;
    GDALSetGeoTransform(memory, t.data());
  }
  if (!sample.crs.empty()) {
    OGRSpatialReferenceH crs = OSRNewSpatialReference(nullptr);
    OSRSetFromUserInput(crs, sample.crs.c_str());
    GDALSetSpatialRef(memory, crs);
    OSRDestroySpatialReference(crs);
  }
  const auto each_pixel = [&](const auto& act) {
    for (int r = 0; r < sample.rows; ++r)
      for (int c = 0; c < sample.columns; ++c)
        act(static_cast<std::size_t>(r) * static_cast<std::size_t>(sample.columns) +
                static_cast<std::size_t>(c),
            t[0] + (c + 0.5) * t[1] + (r + 0.5) * t[2], t[3] + (c + 0.5) * t[4] + (r + 0.5) * t[5]);
  };
  const std::size_t count =
      static_cast<std::size_t>(sample.columns) * static_cast<std::size_t>(sample.rows);
  for (std::size_t i = 0; i < sample.bands.size(); ++i) {
    GDALRasterBandH band = GDALGetRasterBand(memory, static_cast<int>(i) + 1);
    std::vector<double> values(count);
    const bool alpha = sample.bands[i] == "alpha";
    each_pixel([&](std::size_t at, double x, double y) {
      values[at] = alpha ? (sample.mask(x, y) ? 65535 : 0)
                         : sample.value(x, y) + 1000.0 * static_cast<double>(i);
    });
    ASSERT_EQ(GDALRasterIO(band, GF_Write, 0, 0, sample.columns, sample.rows, values.data(),
                           sample.columns, sample.rows, GDT_Float64, 0, 0),
              CE_None);
    GDALSetDescription(band, sample.bands[i].c_str());
    if (alpha) GDALSetRasterColorInterpretation(band, GCI_AlphaBand);
    if (sample.nodata) GDALSetRasterNoDataValue(band, *sample.nodata);
    if (sample.scale) GDALSetRasterScale(band, *sample.scale);
    if (sample.offset) GDALSetRasterOffset(band, *sample.offset);
  }
  if (sample.mask && sample.bands.back() != "alpha") {
    ASSERT_EQ(GDALCreateDatasetMaskBand(memory, GMF_PER_DATASET), CE_None);
    std::vector<unsigned char> mask(count);
    each_pixel([&](std::size_t at, double x, double y) { mask[at] = sample.mask(x, y) ? 255 : 0; });
    ASSERT_EQ(
        GDALRasterIO(GDALGetMaskBand(GDALGetRasterBand(memory, 1)), GF_Write, 0, 0, sample.columns,
                     sample.rows, mask.data(), sample.columns, sample.rows, GDT_Byte, 0, 0),
        CE_None);
  }
  GDALDatasetH file = GDALCreateCopy(GDALGetDriverByName(driver), path.c_str(), memory, FALSE,
                                     nullptr, nullptr, nullptr);
  ASSERT_NE(file, nullptr) << CPLGetLastErrorMsg();
  GDALClose(file);
  GDALClose(memory);
}

}  // namespace weft::files
