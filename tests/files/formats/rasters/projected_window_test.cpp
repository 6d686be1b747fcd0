// SPDX-License-Identifier: Apache-2.0
#include "files/formats/rasters/projected_window.h"

#include <gtest/gtest.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "tests/files/formats/rasters/field_raster_file.h"

namespace weft::files {
namespace {

class ProjectedWindow : public FieldRasterFile {};

TEST_F(ProjectedWindow, OfTextIsReadAsRealNumbersAlsoIfTheFirstAreIntegers) {
  std::string text = "ncols 400\nnrows 500\nxllcorner 0\nyllcorner 0\ncellsize 0.01\n";
  for (int i = 0; i < 400 * 499; ++i) text += "1234567 ";
  for (int i = 0; i < 400; ++i) text += "0.5 ";
  const auto raster = read_field_raster_projected(folder_.write("g.asc", text), "",
                                                  {1, 0.001, 1.1, 0.004}, "EPSG:4326");
  ASSERT_READ(raster);
  EXPECT_GE(std::count(raster->values.begin(), raster->values.end(), 0.5F), raster->columns);
  EXPECT_EQ(std::count(raster->values.begin(), raster->values.end(), 0.0F), 0);
}

// Longitude and latitude of a point of the plane.
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

TEST_F(ProjectedWindow, IsWarpedIntoAPlaneAtItsOwnResolution) {
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

TEST_F(ProjectedWindow, IsWarpedAcrossTheDateLineAndThePoles) {
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

TEST_F(ProjectedWindow, IsWarpedFromItsOwnPlane) {
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

TEST_F(ProjectedWindow, IsBroughtIntoACoordinateSystemThatIsNotItsOwn) {
  const CoordinateSystem utm{"WGS 84 / UTM zone 18N", false, "EPSG:32618"};
  const RasterBox box{500000, 4400000, 580000, 4460000};
  const SampleRaster in_degrees{
      .columns = 200, .rows = 200, .transform = {{-76, 0.02, 0, 43, 0, -0.02}}, .value = plane};
  const auto brought = read_field_raster_in(write(in_degrees), "", box, utm);
  ASSERT_READ(brought);
  expect_projected(*brought, box, "EPSG:32618", plane, 2e-3);
}

TEST_F(ProjectedWindow, IsReadAsItIsInItsOwnCoordinateSystem) {
  const RasterBox box{500000, 4400000, 580000, 4460000};
  SampleRaster sample{.columns = 300,
                      .rows = 300,
                      .transform = {{450000, 1000, 0, 4600000, 0, -1000}},
                      .value = [](double x, double y) { return (x + y) / 1e4; }};
  for (const char* const crs : {"EPSG:32618", ""}) {
    sample.crs = crs;
    const auto raster = read_field_raster_in(write(sample), "", box, {"UTM", false, "EPSG:32618"});
    ASSERT_READ(raster);
    expect_grid(*raster, 498500, 4398500, 1000, 1000, 84, 64);
    expect_values(*raster, [](double x, double y) { return (x + y) / 1e4; });
  }
  const auto nad27 = write({.columns = 10,
                            .rows = 10,
                            .transform = {{-76, 0.1, 0, 43, 0, -0.1}},
                            .value = plane,
                            .crs = "EPSG:4267"});
  const auto degrees = read_field_raster_in(nad27, "", kAll, {"WGS 84", true, "EPSG:4326"});
  ASSERT_READ(degrees);
  EXPECT_DOUBLE_EQ(degrees->x, -75.95);
}

TEST_F(ProjectedWindow, IsUndefinedInAPlaneWhereItHasNoData) {
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

TEST_F(ProjectedWindow, WithoutACoordinateSystemIsTakenForDegreesIfItLooksSo) {
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

}  // namespace
}  // namespace weft::files
