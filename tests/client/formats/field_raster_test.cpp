// SPDX-License-Identifier: Apache-2.0
// Rasters that GDAL reads. Those that weft reads by itself: rasters/raster_window_test.cpp.
#include "client/formats/field_raster.h"

#include <gtest/gtest.h>
#include <ogr_srs_api.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "tests/client/formats/rasters/sample_raster.h"
#include "tests/client/support/temp_folder.h"

namespace weft::client {
namespace {

double plane(double x, double y) {
  return 2 * x + 3 * y;
}

class FieldRasterFile : public testing::Test {
 protected:
  std::filesystem::path write(const SampleRaster& sample, const char* name = "r.tif",
                              const char* driver = "GTiff") {
    write_raster(folder_ / name, driver, sample);
    return folder_ / name;
  }
  // What is said of a raster that must be refused, less the folder.
  std::string refusal(const Result<FieldRaster>& raster) {
    if (raster) return "it was read";
    EXPECT_EQ(raster.error().exit, ExitCode::kUnreadableInput);
    std::string text = raster.error().message;
    for (std::size_t at = 0; (at = text.find(folder_.path().string())) != std::string::npos;)
      text.erase(at, folder_.path().string().size() + 1);
    return text;
  }
  TempFolder folder_;
};

// Every node has the value there, to the precision of a float.
void expect_values(const FieldRaster& raster, double (*value)(double, double)) {
  ASSERT_EQ(raster.values.size(), std::size_t{raster.columns} * raster.rows);
  for (std::size_t row = 0; row < raster.rows; ++row)
    for (std::size_t column = 0; column < raster.columns; ++column) {
      const double x = raster.x + static_cast<double>(column) * raster.dx;
      const double y = raster.y + static_cast<double>(row) * raster.dy;
      ASSERT_NEAR(raster.values[row * raster.columns + column], value(x, y), 1e-3)
          << "at " << x << ", " << y;
    }
}

void expect_grid(const FieldRaster& raster, double x, double y, double dx, double dy,
                 std::uint32_t columns, std::uint32_t rows) {
  EXPECT_DOUBLE_EQ(raster.x, x);
  EXPECT_DOUBLE_EQ(raster.y, y);
  EXPECT_DOUBLE_EQ(raster.dx, dx);
  EXPECT_DOUBLE_EQ(raster.dy, dy);
  EXPECT_EQ(raster.columns, columns);
  EXPECT_EQ(raster.rows, rows);
}

#define ASSERT_READ(raster) ASSERT_TRUE(raster) << (raster).error().message

constexpr RasterBox kAll{-180, -90, 180, 90};

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
  for (const char* wrong : {"0", "4", "-1", "1x", "99999999999999999999"})
    EXPECT_NE(refusal(read_field_raster(path, wrong, kAll)).find("has no band"), std::string::npos);
  for (const auto& [band, value] :
       {std::pair{"1", 1.F}, {"depth", 1.F}, {"speed", 2001.F}, {"2", 1001.F}}) {
    const auto raster = read_field_raster(path, band, kAll);
    ASSERT_READ(raster);
    EXPECT_EQ(raster->values[0], value);
  }
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

// A global raster whose value tells the longitude, from 0 to 360 or from -180 to 180.
SampleRaster globe(double west) {
  return {.columns = 720,
          .rows = 360,
          .transform = {{west, 0.5, 0, 90, 0, -0.5}},
          .value = [](double x, double y) { return std::fmod(x + 720, 360) * 100 + y; },
          .type = GDT_Float32};
}
double of_globe(double x, double y) {
  return std::fmod(x + 720, 360) * 100 + y;
}

TEST_F(FieldRasterFile, OfTheGlobeIsReadAcrossEverySeam) {
  const RasterBox boxes[] = {{-75, 38, -72, 41},  {285, 38, 288, 41},   {175, -5, 185, 5},
                             {-185, -5, -175, 5}, {-5, -5, 5, 5},       {355, -5, 365, 5},
                             {-180, -5, -170, 5}, {170, -90, 180, -80}, {0, 0, 360, 10}};
  for (const double west : {-180.0, 0.0, -30.0})
    for (const RasterBox& box : boxes) {
      SCOPED_TRACE(testing::Message() << west << ": " << box.min_x << " to " << box.max_x);
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
  const auto start = std::chrono::steady_clock::now();
  const auto raster = read_field_raster(folder_ / "huge.tif", "", {30.1, 29.7, 30.3, 29.9});
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  getrusage(RUSAGE_SELF, &after);
  ASSERT_READ(raster);
  EXPECT_NEAR(raster->columns, 204, 1);
  for (const float value : raster->values) ASSERT_EQ(value, 5);
  EXPECT_LT(seconds.count(), 5);
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

TEST_F(FieldRasterFile, OfTextIsReadAsRealNumbersAlsoIfTheFirstAreIntegers) {
  std::string text = "ncols 400\nnrows 500\nxllcorner 0\nyllcorner 0\ncellsize 0.01\n";
  for (int i = 0; i < 400 * 499; ++i) text += "1234567 ";
  for (int i = 0; i < 400; ++i) text += "0.5 ";
  const auto raster = read_field_raster_projected(folder_.write("g.asc", text), "",
                                                  {1, 0.001, 1.1, 0.004}, "EPSG:4326");
  ASSERT_READ(raster);
  EXPECT_GE(std::count(raster->values.begin(), raster->values.end(), 0.5F), raster->columns);
  EXPECT_EQ(std::count(raster->values.begin(), raster->values.end(), 0.0F), 0);
}

// Longitude and latitude of a point of a plane.
std::pair<double, double> degrees(const std::string& crs, double x, double y) {
  OGRSpatialReferenceH from = OSRNewSpatialReference(nullptr);
  OGRSpatialReferenceH to = OSRNewSpatialReference(nullptr);
  OSRSetFromUserInput(from, crs.c_str());
  OSRSetFromUserInput(to, "EPSG:4326");
  OSRSetAxisMappingStrategy(from, OAMS_TRADITIONAL_GIS_ORDER);
  OSRSetAxisMappingStrategy(to, OAMS_TRADITIONAL_GIS_ORDER);
  OGRCoordinateTransformationH transform = OCTNewCoordinateTransformation(from, to);
  OCTTransform(transform, 1, &x, &y, nullptr);
  OCTDestroyCoordinateTransformation(transform);
  OSRDestroySpatialReference(from);
  OSRDestroySpatialReference(to);
  return {x, y};
}

// No value of a node differs by more than this from that of its place on the globe.
void expect_projected(const FieldRaster& raster, const RasterBox& box, const std::string& crs,
                      double (*value)(double, double), double tolerance) {
  EXPECT_LT(raster.x, box.min_x);
  EXPECT_LT(raster.y, box.min_y);
  EXPECT_GT(raster.x + (raster.columns - 1) * raster.dx, box.max_x);
  EXPECT_GT(raster.y + (raster.rows - 1) * raster.dy, box.max_y);
  for (std::uint32_t row = 0; row < raster.rows; row += 3)
    for (std::uint32_t column = 0; column < raster.columns; column += 3) {
      const auto [x, y] = degrees(crs, raster.x + column * raster.dx, raster.y + row * raster.dy);
      ASSERT_NEAR(raster.values[std::size_t{row} * raster.columns + column], value(x, y), tolerance)
          << "at " << x << ", " << y;
    }
}

TEST_F(FieldRasterFile, IsWarpedIntoAPlaneAtItsOwnResolution) {
  const auto path = write(
      {.columns = 200, .rows = 200, .transform = {{-76, 0.02, 0, 43, 0, -0.02}}, .value = plane});
  const RasterBox box{500000, 4400000, 580000, 4460000};
  const auto raster = read_field_raster_projected(path, "", box, "EPSG:32618");
  ASSERT_READ(raster);
  expect_projected(*raster, box, "EPSG:32618", plane, 2e-3);
  // A cell has 1.71 by 2.22 km there.
  EXPECT_NEAR(raster->dx, 1946, 10);
  EXPECT_EQ(raster->dx, raster->dy);
  EXPECT_TRUE(raster->warnings.empty());
  const auto coarse = read_field_raster_projected(path, "", box, "EPSG:32618", 200);
  ASSERT_READ(coarse);
  EXPECT_LE(coarse->values.size(), 200u);
  expect_projected(*coarse, box, "EPSG:32618", plane, 0.02);
}

// Smooth on the whole globe, poles and date line included.
double smooth(double x, double y) {
  const double to_radians = std::acos(-1) / 180;
  return 100 * std::cos(y * to_radians) * std::cos(x * to_radians) + y;
}

TEST_F(FieldRasterFile, IsWarpedAcrossTheDateLineAndThePoles) {
  const std::pair<std::string, RasterBox> cases[] = {
      {"+proj=tmerc +lon_0=180 +datum=WGS84", {-600000, -500000, 600000, 500000}},
      {"+proj=tmerc +lon_0=0 +datum=WGS84", {-600000, 4000000, 600000, 5000000}},
      {"+proj=stere +lat_0=90 +datum=WGS84", {-900000, -700000, 800000, 1000000}},
      {"+proj=stere +lat_0=-90 +datum=WGS84", {-900000, -700000, 800000, 1000000}},
      {"+proj=laea +lat_0=80 +lon_0=170 +datum=WGS84", {-1500000, -1500000, 1500000, 1500000}},
      {"+proj=stere +lat_0=90 +datum=WGS84", {0, 0, 800000, 800000}}};
  for (const double west : {-180.0, 0.0})
    for (const auto& [crs, box] : cases) {
      SCOPED_TRACE(crs);
      SampleRaster sample = globe(west);
      sample.value = smooth;
      const auto raster = read_field_raster_projected(write(sample), "", box, crs);
      ASSERT_READ(raster);
      expect_projected(*raster, box, crs, smooth, 0.5);
      EXPECT_TRUE(raster->warnings.empty());
    }
}

TEST_F(FieldRasterFile, IsWarpedFromItsOwnPlane) {
  const auto path = write({.columns = 300,
                           .rows = 300,
                           .transform = {{450000, 1000, 0, 4600000, 0, -1000}},
                           .value = [](double x, double y) { return (x + y) / 1e4; },
                           .crs = "EPSG:32618"});
  const RasterBox box{-74, 40, -73, 41};
  const auto raster = read_field_raster_projected(path, "", box, "EPSG:4326");
  ASSERT_READ(raster);
  const auto same =
      read_field_raster_projected(path, "", {500000, 4400000, 600000, 4500000}, "EPSG:32618");
  ASSERT_READ(same);
  EXPECT_NEAR(same->dx, 1000, 1e-3);
  expect_values(*same, [](double x, double y) { return (x + y) / 1e4; });
  // The north-west corner of the box is in the raster, and has its value.
  const auto at = [&](double x, double y) {
    return raster->values[static_cast<std::size_t>(std::lround((y - raster->y) / raster->dy)) *
                              raster->columns +
                          static_cast<std::size_t>(std::lround((x - raster->x) / raster->dx))];
  };
  EXPECT_NEAR(at(-74, 40), (585360 + 4428236) / 1e4, 0.15);
  EXPECT_NE(refusal(read_field_raster_projected(path, "", {10, 40, 11, 41}, "EPSG:4326"))
                .find("does not meet"),
            std::string::npos);
}

TEST_F(FieldRasterFile, IsUndefinedInAPlaneWhereItHasNoData) {
  const auto path = write({.columns = 100,
                           .rows = 100,
                           .transform = {{-75, 0.02, 0, 41, 0, -0.02}},
                           .value = [](double x, double) { return x < -74 ? -1 : 5; },
                           .nodata = -1});
  const RasterBox box{500000, 4340000, 660000, 4500000};
  const auto raster = read_field_raster_projected(path, "", box, "EPSG:32618");
  ASSERT_READ(raster);
  int defined = 0;
  for (std::uint32_t row = 0; row < raster->rows; ++row)
    for (std::uint32_t column = 0; column < raster->columns; ++column) {
      const auto [x, y] =
          degrees("EPSG:32618", raster->x + column * raster->dx, raster->y + row * raster->dy);
      const float value = raster->values[std::size_t{row} * raster->columns + column];
      constexpr double kBeside = 0.03;  // of the raster: two pixels from the middle of its last
      // > 0: has data
      const double edge = std::min({x + 74, -73 + kBeside - x, y - 39 + kBeside, 41 + kBeside - y});
      if (std::abs(edge) < 0.001) continue;
      EXPECT_EQ(std::isnan(value), edge < 0) << x << ", " << y;
      if (edge > 0) {
        EXPECT_EQ(value, 5);
        ++defined;
      }
    }
  EXPECT_GT(defined, 1000);
}

TEST_F(FieldRasterFile, WithoutACoordinateSystemIsTakenForDegreesIfItLooksSo) {
  const RasterBox box{500000, 4400000, 580000, 4460000};
  const auto path = write({.columns = 200,
                           .rows = 200,
                           .transform = {{-76, 0.02, 0, 43, 0, -0.02}},
                           .value = plane,
                           .crs = ""});
  const auto raster = read_field_raster_projected(path, "", box, "EPSG:32618");
  ASSERT_READ(raster);
  expect_projected(*raster, box, "EPSG:32618", plane, 2e-3);
  ASSERT_EQ(raster->warnings.size(), 1u);
  EXPECT_NE(raster->warnings[0].find("EPSG:4326"), std::string::npos);
  EXPECT_NE(refusal(read_field_raster_projected(path, "", box, "EPSG:nonsense"))
                .find("the coordinate system 'EPSG:nonsense' is not understood"),
            std::string::npos);
  const auto metres = write({.columns = 20,
                             .rows = 20,
                             .transform = {{500000, 1000, 0, 4460000, 0, -1000}},
                             .value = plane,
                             .crs = ""});
  EXPECT_NE(refusal(read_field_raster_projected(metres, "", box, "EPSG:32618"))
                .find("r.tif: has no coordinate system, and its coordinates are no degrees"),
            std::string::npos);
}

TEST(Weft, DoesNotLoadGdalWhenItStarts) {
  FILE* const list = ::popen("ldd " WEFT_BINARY, "r");
  ASSERT_NE(list, nullptr);
  std::string text;
  for (int c; (c = std::fgetc(list)) != EOF;) text += static_cast<char>(c);
  EXPECT_EQ(::pclose(list), 0);
  EXPECT_NE(text.find("libc.so"), std::string::npos);
  EXPECT_EQ(text.find("gdal"), std::string::npos);
}

}  // namespace
}  // namespace weft::client
