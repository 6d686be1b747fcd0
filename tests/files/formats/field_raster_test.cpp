// SPDX-License-Identifier: Apache-2.0
// Rasters that GDAL reads, without a projection (rasters/projected_window_test.cpp). Those that
// weft reads by itself: rasters/raster_window_test.cpp.
#include "files/formats/field_raster.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <string>

#include "tests/files/formats/rasters/field_raster_file.h"
#include "tests/support/paths.h"

namespace weft::files {
namespace {

TEST_F(FieldRasterFile, HasItsNodesAtTheCentresOfPixelsWhicheverWayItLies) {
  const std::array<double, 6> ways[] = {{10, 2, 0, 21, 0, -0.5},
                                        {10, 2, 0, 20, 0, 0.5},
                                        {16, -2, 0, 21, 0, -0.5},
                                        {16, -2, 0, 20, 0, 0.5}};
  for (const auto& way : ways) {
    const auto raster = read_field_raster(
        write({.columns = 3, .rows = 2, .transform = way, .value = plane}), "", kAll);
    ASSERT_READ(raster);
    expect_grid(*raster, 11, 20.25, 2, 0.5, 3, 2);
    expect_values(*raster, plane);
    EXPECT_TRUE(raster->warnings.empty());
  }
}

TEST_F(FieldRasterFile, IsCutToTheBoxAndTwoNodesMore) {
  const auto path = write(
      {.columns = 100, .rows = 80, .transform = {{0, 1, 0, 80, 0, -1}}, .value = plane, .crs = ""});
  const auto inside = read_field_raster(path, "", {20, 30, 24.6, 30.5});
  ASSERT_READ(inside);
  // Nodes are at halves; 30.5 is one of them.
  expect_grid(*inside, 18.5, 28.5, 1, 1, 9, 5);
  expect_values(*inside, plane);
  const auto corner = read_field_raster(path, "", {-7, 79, 1, 300});
  ASSERT_READ(corner);
  expect_grid(*corner, 0.5, 77.5, 1, 1, 3, 3);
  expect_values(*corner, plane);
}

TEST_F(FieldRasterFile, OfOneCellHasOneNode) {
  const auto raster =
      read_field_raster(write({.transform = {{4, 2, 0, 8, 0, -2}}, .value = plane}), "", kAll);
  ASSERT_READ(raster);
  expect_grid(*raster, 5, 7, 2, 2, 1, 1);
  expect_values(*raster, plane);
}

TEST_F(FieldRasterFile, IsRefusedIfItIsRotatedOrHasNoPlace) {
  const auto rotated =
      write({.columns = 4, .rows = 4, .transform = {{10, 1, 0.3, 20, 0.3, -1}}, .value = plane});
  EXPECT_EQ(refusal(read_field_raster(rotated, "", kAll)),
            "r.tif: its geotransform, 10, 1, 0.3, 20, 0.3, -1, is rotated or sheared; gdalwarp "
            "makes it upright");
  const auto nowhere = write({.columns = 4, .rows = 4, .transform = {}, .value = plane, .crs = ""});
  EXPECT_NE(refusal(read_field_raster(nowhere, "", kAll)).find("no geotransform"),
            std::string::npos);
}

TEST_F(FieldRasterFile, HasScaleAndOffsetApplied) {
  const auto raster = read_field_raster(
      write({.columns = 2,
             .rows = 2,
             .transform = {{0, 1, 0, 2, 0, -1}},
             .value = [](double x, double y) { return std::floor(x) + 10 * std::floor(y); },
             .type = GDT_Int16,
             .nodata = 11,
             .scale = 0.1,
             .offset = -5}),
      "", kAll);
  ASSERT_READ(raster);
  EXPECT_FLOAT_EQ(raster->values[0], -5);
  EXPECT_FLOAT_EQ(raster->values[1], -4.9F);
  EXPECT_FLOAT_EQ(raster->values[2], -4);
  EXPECT_TRUE(std::isnan(raster->values[3]));  // nodata is of the numbers in the file
}

TEST_F(FieldRasterFile, IsNanWithoutData) {
  const auto only_west = [](double x, double) { return x < 2; };
  SampleRaster sample{.columns = 4, .rows = 1, .transform = {{0, 1, 0, 1, 0, -1}}, .value = plane};
  SampleRaster nodata = sample;
  nodata.nodata = -9999;
  nodata.value = [&](double x, double y) { return only_west(x, y) ? plane(x, y) : -9999; };
  SampleRaster masked = sample;
  masked.mask = only_west;
  SampleRaster alpha = masked;
  alpha.type = GDT_UInt16;
  alpha.scale = 0.1;
  alpha.bands = {"", "alpha"};
  alpha.value = [](double x, double y) { return 10 * plane(x, y); };
  SampleRaster infinite = sample;
  infinite.value = [&](double x, double) {
    return x < 1 ? 2.5 : x < 2 ? 4.5 : x < 3 ? 1e300 : -std::numeric_limits<double>::infinity();
  };
  SampleRaster nan = sample;
  nan.value = [&](double x, double y) { return only_west(x, y) ? plane(x, y) : NAN; };
  int index = 0;
  for (const SampleRaster& each : {nodata, masked, alpha, infinite, nan}) {
    SCOPED_TRACE(index++);
    const auto raster = read_field_raster(write(each), "", kAll);
    ASSERT_READ(raster);
    ASSERT_EQ(raster->columns, 4u);
    EXPECT_FLOAT_EQ(raster->values[0], 2.5);
    EXPECT_FLOAT_EQ(raster->values[1], 4.5);
    EXPECT_TRUE(std::isnan(raster->values[2]));
    EXPECT_TRUE(std::isnan(raster->values[3]));
    EXPECT_TRUE(raster->warnings.empty());
  }
}

TEST_F(FieldRasterFile, WithoutAnyDataIsReadWithAWarning) {
  const auto raster = read_field_raster(write({.columns = 3,
                                               .rows = 3,
                                               .transform = {{0, 1, 0, 3, 0, -1}},
                                               .value = [](double, double) { return -1.0; },
                                               .nodata = -1}),
                                        "", kAll);
  ASSERT_READ(raster);
  for (const float value : raster->values) EXPECT_TRUE(std::isnan(value));
  ASSERT_EQ(raster->warnings.size(), 1u);
  EXPECT_TRUE(raster->warnings[0].ends_with("r.tif: has no data in the domain's box"));
}

TEST_F(FieldRasterFile, HasItsBandChosenByNumberOrName) {
  const auto path = write({.columns = 2,
                           .rows = 2,
                           .transform = {{0, 1, 0, 2, 0, -1}},
                           .value = [](double, double) { return 1.0; },
                           .bands = {"depth", "", "speed"}});
  EXPECT_EQ(refusal(read_field_raster(path, "", kAll)),
            "r.tif: has 3 bands; name one as in r.tif:1; there are 1 'depth', 2, 3 'speed'");
  EXPECT_EQ(refusal(read_field_raster(path, "height", kAll)),
            "r.tif: has no band 'height'; there are 1 'depth', 2, 3 'speed'");
  EXPECT_EQ(refusal(read_field_raster(path, "1:2", kAll)),
            "r.tif: has no band '1:2'; there are 1 'depth', 2, 3 'speed'");
  for (const char* wrong : {"0", "4", "-1", "1x", ":1", "99999999999999999999"})
    EXPECT_NE(refusal(read_field_raster(path, wrong, kAll)).find("has no band"), std::string::npos);
  for (const auto& [band, value] :
       {std::pair{"1", 1.F}, {"depth", 1.F}, {"speed", 2001.F}, {"2", 1001.F}}) {
    const auto raster = read_field_raster(path, band, kAll);
    ASSERT_READ(raster);
    EXPECT_EQ(raster->values[0], value);
  }
}

TEST_F(FieldRasterFile, OfComplexNumbersIsRefusedByItsBand) {
  SampleRaster sample{.columns = 2,
                      .rows = 2,
                      .transform = {{0, 1, 0, 2, 0, -1}},
                      .value = plane,
                      .type = GDT_CFloat32,
                      .bands = {"", "phase"}};
  const auto two = write(sample);
  EXPECT_EQ(refusal(read_field_raster(two, "phase", kAll)),
            "r.tif: the values of band 2 'phase' are complex numbers");
  EXPECT_EQ(refusal(read_field_raster(two, "1", kAll)),
            "r.tif: the values of band 1 are complex numbers");
  sample.bands = {""};
  EXPECT_EQ(refusal(read_field_raster(write(sample, "one.tif"), "", kAll)),
            "one.tif: the values of band 1 are complex numbers");
}

TEST_F(FieldRasterFile, OfNetcdfHasItsVariableChosenByName) {
  SampleRaster sample{
      .columns = 6, .rows = 4, .transform = {{10, 1, 0, 44, 0, -1}}, .value = plane};
  const auto one = read_field_raster(write(sample, "one.nc", "netCDF"), "", kAll);
  ASSERT_READ(one);
  expect_grid(*one, 10.5, 40.5, 1, 1, 6, 4);
  expect_values(*one, plane);
  ASSERT_READ(read_field_raster(folder_ / "one.nc", "Band1", kAll));

  sample.bands = {"", ""};
  const auto two = write(sample, "two.nc", "netCDF");
  EXPECT_EQ(refusal(read_field_raster(two, "", kAll)),
            "two.nc: has 2 variables; name one as in two.nc:1; there are 1 'Band1', 2 'Band2'");
  EXPECT_NE(refusal(read_field_raster(two, "depth", kAll)).find("has no variable 'depth'"),
            std::string::npos);
  for (const char* name : {"Band2", "2", "Band2:1"}) {
    const auto raster = read_field_raster(two, name, kAll);
    ASSERT_READ(raster);
    expect_values(*raster, [](double x, double y) { return plane(x, y) + 1000; });
  }
}

TEST_F(FieldRasterFile, OfOtherFormatsIsReadToo) {
  const SampleRaster sample{.columns = 5,
                            .rows = 3,
                            .transform = {{0.5, 1, 0, 3.5, 0, -1}},
                            .value = plane,
                            .type = GDT_Float32};
  write(sample);
  for (const auto& [name, driver] : {std::pair{"r.img", "HFA"}, {"r.bil", "EHdr"}}) {
    SCOPED_TRACE(name);
    const auto raster = read_field_raster(write(sample, name, driver), "", kAll);
    ASSERT_READ(raster);
    expect_grid(*raster, 1, 1, 1, 1, 5, 3);
    expect_values(*raster, plane);
  }
}

TEST_F(FieldRasterFile, ApartFromTheBoxIsRefusedWithBoth) {
  const auto path =
      write({.columns = 10, .rows = 10, .transform = {{10, 1, 0, 50, 0, -1}}, .value = plane});
  EXPECT_EQ(refusal(read_field_raster(path, "", {20.5, 40, 30, 50})),
            "r.tif: the raster, (10, 40) to (20, 50) in WGS 84, does not meet the domain's box, "
            "(20.5, 40) to (30, 50)");
  EXPECT_NE(refusal(read_field_raster(path, "", {10, 51, 20, 52})).find("does not meet"),
            std::string::npos);
  EXPECT_NE(refusal(read_field_raster(path, "", {3e6, 4e6, 3.1e6, 4.1e6})).find("does not meet"),
            std::string::npos);
}

TEST_F(FieldRasterFile, OfTheGlobeIsReadAcrossEverySeam) {
  const RasterBox boxes[] = {{-75, 38, -72, 41},  {285, 38, 288, 41},   {175, -5, 185, 5},
                             {-185, -5, -175, 5}, {-5, -5, 5, 5},       {355, -5, 365, 5},
                             {-180, -5, -170, 5}, {170, -90, 180, -80}, {0, 0, 360, 10}};
  for (const double west : {-180.0, 0.0, -30.0})
    for (const RasterBox& box : boxes) {
      SCOPED_TRACE(::testing::Message() << west << ": " << box.min_x << " to " << box.max_x);
      const auto raster = read_field_raster(write(globe(west)), "", box);
      ASSERT_READ(raster);
      EXPECT_LT(raster->x, box.min_x);
      EXPECT_GT(raster->x, box.min_x - 1.1);
      EXPECT_GT(raster->x + (raster->columns - 1) * raster->dx, box.max_x);
      expect_values(*raster, of_globe);
      EXPECT_TRUE(raster->warnings.empty());
    }
}

TEST_F(FieldRasterFile, OfAPartOfTheGlobeIsShiftedToTheBox) {
  SampleRaster sample{
      .columns = 20, .rows = 10, .transform = {{280, 1, 0, 45, 0, -1}}, .value = of_globe};
  const auto raster = read_field_raster(write(sample), "", {-75, 38, -60.2, 41});
  ASSERT_READ(raster);
  expect_grid(*raster, -76.5, 36.5, 1, 1, 17, 7);  // it ends at -60
  expect_values(*raster, of_globe);
  EXPECT_TRUE(raster->warnings.empty());

  // Two parts of a box that goes round; between them there is nothing.
  sample.columns = 340;
  sample.transform = {{-170, 1, 0, 45, 0, -1}};
  const auto wrapped = read_field_raster(write(sample), "", {165, 38, 195, 41});
  ASSERT_READ(wrapped);
  expect_grid(*wrapped, 163.5, 36.5, 1, 1, 34, 7);
  for (std::uint32_t i = 0; i < wrapped->columns; ++i) {
    const double x = wrapped->x + i;
    if (x > 170 && x < 190)
      EXPECT_TRUE(std::isnan(wrapped->values[i])) << x;
    else
      EXPECT_FLOAT_EQ(wrapped->values[i], static_cast<float>(of_globe(x, 36.5))) << x;
  }
}

TEST_F(FieldRasterFile, InMetresIsNotShifted) {
  const auto path = write({.columns = 20,
                           .rows = 10,
                           .transform = {{280, 1, 0, 45, 0, -1}},
                           .value = plane,
                           .crs = "EPSG:32618"});
  EXPECT_NE(refusal(read_field_raster(path, "", {-75, 38, -60, 41})).find("does not meet"),
            std::string::npos);
}

TEST_F(FieldRasterFile, OfMoreValuesThanTheLimitIsAveraged) {
  const auto path = write({.columns = 300,
                           .rows = 200,
                           .transform = {{0, 0.1, 0, 20, 0, -0.1}},
                           .value = [](double x, double y) { return x < 1 ? -1 : plane(x, y); },
                           .nodata = -1});
  const auto raster = read_field_raster(path, "", {10, 5, 20, 15}, 1000);
  ASSERT_READ(raster);
  EXPECT_LE(raster->values.size(), 1000u);
  EXPECT_GE(raster->values.size(), 500u);
  EXPECT_NEAR(raster->dx, 0.4, 1e-12);
  EXPECT_LT(raster->x + raster->dx, 10);
  EXPECT_GT(raster->x + (raster->columns - 2) * raster->dx, 20);
  expect_values(*raster, plane);
  ASSERT_EQ(raster->warnings.size(), 1u);
  EXPECT_NE(raster->warnings[0].find("r.tif: read at a resolution of (0.4, 0.4), not its own of "
                                     "(0.1, 0.1), because the domain's box has more than 1,000"),
            std::string::npos)
      << raster->warnings[0];
  // Means are of what has data; the first 10 columns have none, which ends inside of a square.
  const auto border = read_field_raster(path, "", {0, 5, 10, 15}, 400);
  ASSERT_READ(border);
  EXPECT_TRUE(std::isnan(border->values[0]));
  std::uint32_t i = 0;
  while (std::isnan(border->values[i])) ++i;
  EXPECT_GT(border->x + (i + 0.5) * border->dx, 1);
  EXPECT_LT(border->x + (i - 0.5) * border->dx, 1);
  EXPECT_GT(border->values[i], 2);
}

TEST_F(FieldRasterFile, OfMoreValuesThanTheLimitIsReadFromItsOverviews) {
  write({.columns = 400, .rows = 400, .transform = {{0, 0.1, 0, 40, 0, -0.1}}, .value = plane},
        "full.tif");
  write({.columns = 100,
         .rows = 100,
         .transform = {{0, 0.4, 0, 40, 0, -0.4}},
         .value = [](double, double) { return 7.0; }},
        "coarse.tif");
  const auto path = folder_.write("o.vrt", R"(
<VRTDataset rasterXSize="400" rasterYSize="400">
<GeoTransform>0, 0.1, 0, 40, 0, -0.1</GeoTransform>
<VRTRasterBand dataType="Float64" band="1">
<SimpleSource><SourceFilename relativeToVRT="1">full.tif</SourceFilename></SimpleSource>
<Overview><SourceFilename relativeToVRT="1">coarse.tif</SourceFilename></Overview>
</VRTRasterBand></VRTDataset>)");
  const auto full = read_field_raster(path, "", {0, 0, 40, 40}, 160000);
  ASSERT_READ(full);
  expect_values(*full, plane);
  const auto coarse = read_field_raster(path, "", {0, 0, 40, 40}, 12000);
  ASSERT_READ(coarse);
  expect_grid(*coarse, 0.2, 0.2, 0.4, 0.4, 100, 100);
  expect_values(*coarse, [](double, double) { return 7.0; });
  ASSERT_EQ(coarse->warnings.size(), 1u);
}

TEST_F(FieldRasterFile, OfBillionsOfPixelsCostsWhatTheBoxNeeds) {
  GDALAllRegister();
  char sparse[] = "SPARSE_OK=TRUE", tiled[] = "TILED=YES";
  char* options[] = {sparse, tiled, nullptr};
  GDALDatasetH file = GDALCreate(GDALGetDriverByName("GTiff"), (folder_ / "huge.tif").c_str(),
                                 60000, 60000, 1, GDT_Float32, options);
  double transform[] = {0, 0.001, 0, 60, 0, -0.001};
  GDALSetGeoTransform(file, transform);
  const std::vector<float> values(400 * 400, 5);
  ASSERT_EQ(GDALRasterIO(GDALGetRasterBand(file, 1), GF_Write, 30000, 30000, 400, 400,
                         const_cast<float*>(values.data()), 400, 400, GDT_Float32, 0, 0),
            CE_None);
  GDALClose(file);
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  const std::clock_t start = std::clock();
  const auto raster = read_field_raster(folder_ / "huge.tif", "", {30.1, 29.7, 30.3, 29.9});
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  getrusage(RUSAGE_SELF, &after);
  ASSERT_READ(raster);
  EXPECT_NEAR(raster->columns, 204, 1);
  for (const float value : raster->values) ASSERT_EQ(value, 5);
  EXPECT_LT(seconds, 5);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 200 * 1024);  // KiB
}

TEST_F(FieldRasterFile, ThatIsDamagedIsAnErrorOrARaster) {
  const SampleRaster sample{
      .columns = 60, .rows = 40, .transform = {{10, 0.1, 0, 44, 0, -0.1}}, .value = plane};
  for (const auto& [name, driver] :
       {std::pair{"d.tif", "GTiff"}, {"d.nc", "netCDF"}, {"d.img", "HFA"}}) {
    const std::string whole = contents_of(write(sample, name, driver));
    int errors = 0;
    for (int i = 0; i < 40; ++i) {
      std::string part = whole.substr(0, whole.size() * static_cast<std::size_t>(i) / 40);
      if (i % 2 == 1) {  // damaged, not cut
        part = whole;
        for (std::size_t j = static_cast<std::size_t>(i); j < 400 && j < part.size(); j += 41)
          part[j] = static_cast<char>(part[j] ^ (1 << (i % 8)));
      }
      const auto raster = read_field_raster(folder_.write(name, part), "", kAll);
      if (!raster) {
        ++errors;
        EXPECT_NE(refusal(raster).find(name), std::string::npos);
      } else {
        EXPECT_EQ(raster->values.size(), std::size_t{raster->columns} * raster->rows);
      }
    }
    EXPECT_GT(errors, 10) << name;
  }
}

TEST_F(FieldRasterFile, MustBeAFile) {
  EXPECT_EQ(refusal(read_field_raster(folder_ / "none.tif", "", kAll)), "none.tif: no such file");
  EXPECT_EQ(refusal(read_field_raster("PG:dbname=weft", "", kAll)), "PG:dbname=weft: no such file");
  EXPECT_NE(refusal(read_field_raster(folder_.write("t.txt", "no raster"), "", kAll))
                .find("not recognized as a supported file format"),
            std::string::npos);
}

TEST(Weft, DoesNotLoadGdalWhenItStarts) {
  FILE* const list = ::popen((std::string("ldd ") + weft::testing::kWeft).c_str(), "r");
  ASSERT_NE(list, nullptr);
  std::string text;
  for (int c; (c = std::fgetc(list)) != EOF;) text += static_cast<char>(c);
  EXPECT_EQ(::pclose(list), 0);
  EXPECT_NE(text.find("libc.so"), std::string::npos);
  EXPECT_EQ(text.find("gdal"), std::string::npos);
}

}  // namespace
}  // namespace weft::files
