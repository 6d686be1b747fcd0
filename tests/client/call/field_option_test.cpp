// SPDX-License-Identifier: Apache-2.0
#include "client/call/field_option.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/call/mesh_request.h"
#include "client/call/request_rows.h"
#include "tests/files/support/sample_mesh.h"
#include "tests/files/support/shapefile_writer.h"
#include "tests/files/support/temp_folder.h"

namespace weft::client {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

FieldOption parsed(const std::string& text) {
  return FieldOption::parse(text, "folder").value();
}

std::string fault(const std::string& text) {
  const auto field = FieldOption::parse(text, "folder");
  return field ? "" : field.error();
}

TEST(FieldOption, NamesAKind) {
  EXPECT_EQ(parsed("coast=distance").name, "coast");
  EXPECT_TRUE(std::get<wire::DomainField>(parsed("coast=distance").kind).distance->markers.empty());
  const auto named =
      *std::get<wire::DomainField>(parsed("c=distance:marker=inlet,4,wall").kind).distance;
  EXPECT_THAT(named.markers, ElementsAre(4));
  EXPECT_THAT(named.names, ElementsAre("inlet", "wall"));
  EXPECT_THAT(std::get<wire::DomainField>(parsed("c=distance:marker=2,-3").kind).distance->markers,
              ElementsAre(2, -3));
  EXPECT_EQ(std::get<FieldOption::DistanceToFile>(parsed("c=distance:a/b.geojson").kind).file,
            "folder/a/b.geojson");
  EXPECT_FALSE(std::get<wire::DomainField>(parsed("w=width").kind).distance);
}

TEST(FieldOption, IsARasterWithOrWithoutABand) {
  const TempFolder folder;
  const auto raster = [&](const std::string& text) {
    return std::get<FieldOption::Raster>(FieldOption::parse(text, folder.path())->kind);
  };
  const std::filesystem::path depths = folder.write("a=b.nc", "");
  EXPECT_EQ(raster("d=a=b.nc").file, depths);
  EXPECT_EQ(raster("d=a=b.nc").band, "");
  EXPECT_EQ(raster("d=a=b.nc:elevation").file, depths);
  EXPECT_EQ(raster("d=a=b.nc:elevation").band, "elevation");
  EXPECT_EQ(raster("d=" + depths.string() + ":2").file, depths);
  EXPECT_EQ(raster("d=none.tif").file, folder / "none.tif");
}

TEST(FieldOption, IsOnAnEarlierMesh) {
  const TempFolder folder;
  const auto on_mesh = [&](const std::string& text) {
    return std::get<FieldOption::OnMesh>(FieldOption::parse(text, folder.path())->kind);
  };
  const std::filesystem::path old = folder.write("a:b.vtu", "");
  EXPECT_EQ(on_mesh("h=mesh:a:b.vtu").file, old);
  EXPECT_EQ(on_mesh("h=mesh:a:b.vtu").array, "");
  EXPECT_EQ(on_mesh("h=mesh:a:b.vtu:u:v").file, old);
  EXPECT_EQ(on_mesh("h=mesh:a:b.vtu:u:v").array, "u:v");
  EXPECT_EQ(on_mesh("h=mesh:none.npz:h").file, folder / "none.npz");
  EXPECT_EQ(on_mesh("h=mesh:none.npz:h").array, "h");
}

TEST(FieldOption, WithAFaultSaysWhatIsWrong) {
  for (const char* const text : {"coast", "=distance", "coast=", ""})
    EXPECT_THAT(fault(text), HasSubstr("is not NAME=KIND, such as coast=distance")) << text;
  for (const char* const text :
       {"c=distance:marker=", "c=distance:marker=1,", "c=distance:marker=a,,b"})
    EXPECT_THAT(fault(text), HasSubstr("does not list markers, such as marker=2,3")) << text;
  EXPECT_THAT(fault("c=distance:coast.tif"), HasSubstr("'.tif' is not that of a domain"));
  EXPECT_THAT(fault("h=mesh:m.stl:h"), HasSubstr("'.stl' is not that of a mesh with values"));
}

TEST(FieldOption, ThatIsNearlyAKindIsToldWhichOne) {
  EXPECT_EQ(fault("d=distanse"),
            "'distanse' is neither a kind of field nor a file; did you mean `distance`?");
  EXPECT_THAT(fault("d=widht"), HasSubstr("did you mean `width`?"));
  EXPECT_THAT(fault("d=mseh:a"), HasSubstr("did you mean `mesh`?"));
  EXPECT_THAT(fault("d=width:3"), HasSubstr("width takes nothing after it"));
  EXPECT_THAT(fault("d=mesh"), HasSubstr("mesh takes a file"));
  EXPECT_THAT(fault("d=mesh:"), HasSubstr("mesh takes a file"));
  EXPECT_THAT(fault("d=bathymetry"), HasSubstr("the kinds are distance, width and mesh"));
  EXPECT_EQ(fault("d=distance:markers=2"),
            "'distance:markers=2' names neither markers, such as distance:marker=2,3, nor a file; "
            "did you mean `marker`?");
  EXPECT_THAT(fault("d=distance:inlet"), HasSubstr("such as distance:marker=2,3, nor a file"));
}

TEST(FieldOption, MayBeAFileThatIsCalledNearlyAsAKindIs) {
  const TempFolder folder;
  const std::filesystem::path raster = folder.write("widht", "");
  EXPECT_EQ(std::get<FieldOption::Raster>(FieldOption::parse("d=widht", folder.path())->kind).file,
            raster);
  EXPECT_EQ(
      std::get<FieldOption::Raster>(FieldOption::parse("d=widht:2", folder.path())->kind).band,
      "2");
}

// The grid is read at half its resolution.
TEST(FieldOption, BringsOfARasterNoMoreValuesThanItMay) {
  const TempFolder folder;
  std::string grid = "ncols 8\nnrows 8\nxllcorner 0\nyllcorner 0\ncellsize 0.5\n";
  for (int i = 0; i < 64; ++i) grid += "3 ";
  folder.write("a.asc", grid);
  const auto field = FieldOption::parse("r=a.asc", folder.path());
  ASSERT_TRUE(field) << field.error();
  v1::NamedField filled;
  const auto warnings = fill(*field, square_domain(4), nullptr, 32, filled);
  ASSERT_TRUE(warnings) << warnings.error().message;
  EXPECT_EQ(warnings->size(), 1u);
  EXPECT_EQ(filled.raster().values_size(), 16);
}

class Sizes : public ::testing::Test {
 protected:
  // The size of the request.
  v1::SizeField size(const RequestOptions& options) const {
    const auto read = with_size(options, square_domain(4));
    EXPECT_TRUE(read) << read.error().message;
    return read ? make_request(square_domain(4), *read).size() : v1::SizeField();
  }

  // Options as flags give them: names and texts.
  RequestOptions given(
      const std::vector<std::pair<std::string, std::vector<std::string>>>& flags) const {
    RequestOptions options;
    for (const auto& [name, texts] : flags)
      for (const auto& row : size_rows())
        if (row.name == name) {
          EXPECT_EQ(row.value.read(texts, folder_.path(), options), "");
        }
    return options;
  }
  static std::string refusal(const RequestOptions& options,
                             const DomainProjection* projection = nullptr) {
    const auto read = with_size(options, square_domain(4), projection);
    return read ? "" : read.error().message;
  }

  TempFolder folder_;
};

TEST_F(Sizes, ThatCannotBeReadNameTheirFlag) {
  const std::string none = (folder_ / "none").string();
  EXPECT_EQ(refusal(given({{"edge", {"none.asc"}}})),
            "--edge: " + none + ".asc: No such file or directory");
  EXPECT_EQ(refusal(given({{"edge", {"a"}}, {"field", {"w=width", "a=none.tif"}}})),
            "--field a: " + none + ".tif: no such file");
  EXPECT_EQ(refusal(given({{"field", {"a=distance:marker=inlet"}}})),
            "--field a: no marker of the domain is named 'inlet': it names none");
  RequestOptions at = given({{"edge-at", {"marker=2:1", "marker=inlet:1"}}});
  EXPECT_THAT(refusal(at), HasSubstr("--edge-at marker=inlet: no marker of the domain is named"));
  at.from_manifest = true;
  EXPECT_THAT(refusal(at), ::testing::StartsWith("edge-at marker=inlet: no marker"));
}

TEST_F(Sizes, AreNoPathsOfFiles) {
  folder_.write("depth.tif", "");
  folder_.write("old.npz", "");
  folder_.write("coast.geojson", "");
  folder_.write("x", "");
  folder_.write("1.5", "");
  for (const auto& row : size_rows()) {
    if (row.name != "size" && row.name != "edge") continue;
    RequestOptions options;
    const auto fault_of = [&](const std::string& text) {
      return row.value.read({text}, folder_.path(), options);
    };
    EXPECT_EQ(fault_of("depth.tif"),
              "'depth.tif' is a file, not an expression: make it a field, d=depth.tif, whose name "
              "an expression can use");
    EXPECT_THAT(fault_of("old.npz"), HasSubstr("d=mesh:old.npz"));
    EXPECT_THAT(fault_of("coast.geojson"), HasSubstr("d=distance:coast.geojson"));
    folder_.write("waves.nc", "CDF");
    EXPECT_THAT(fault_of("waves.nc"), HasSubstr("d=waves.nc,"));
    EXPECT_EQ(fault_of("none.tif"), "'none.tif' is no expression, and there is no such file");
    for (const char* const text : {"x", "1.5", "2.e5*x"}) EXPECT_EQ(fault_of(text), "") << text;
  }
}

TEST_F(Sizes, OfLinesThatCannotBeProjectedNameThePoint) {
  folder_.write("metres.wkt", "LINESTRING (1 1, 500000 4649846)");
  folder_.write("far.wkt", "LINESTRING (1 1, 91 0)");
  Domain domain = square_domain(4);
  const auto projection = DomainProjection::project(domain, {.crs = "+proj=tmerc +lon_0=1"});
  if (!Projection::available()) GTEST_SKIP() << "built without PROJ";
  ASSERT_TRUE(projection) << projection.error().message;
  EXPECT_EQ(refusal(given({{"field", {"a=distance:metres.wkt"}}}), &*projection),
            "--field a: " + (folder_ / "metres.wkt").string() +
                ": line 1, geometry 0[1]: point 1, (5e+05, 4649846), is not a longitude and a "
                "latitude; are its "
                "coordinates metres?");
  EXPECT_THAT(refusal(given({{"field", {"a=distance:far.wkt"}}}), &*projection),
              HasSubstr("point 1, (91, 0), is too far from the domain to be projected by +proj="));
}

TEST_F(Sizes, MayBeLengthsOfEdges) {
  EXPECT_EQ(size({.edge = "3"}).measure(), v1::MEASURE_EDGE);
  EXPECT_EQ(size({.edge = "3"}).constant(), 3);
  EXPECT_EQ(size({.edge = "x + 1"}).expression(), "x + 1");
  EXPECT_EQ(size({.size = "x + 1"}).measure(), v1::MEASURE_UNSPECIFIED);
  const auto both = with_size({.size = "1", .edge = "1"}, square_domain(4));
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().exit, ExitCode::kUsage);
}

TEST_F(Sizes, AreNoEmptyTexts) {
  for (const auto& row : size_rows()) {
    if (row.name != "size" && row.name != "edge") continue;
    RequestOptions options;
    EXPECT_NE(row.value.read({""}, "", options), "");
  }
}

TEST_F(Sizes, BringTheirFields) {
  const std::filesystem::path lines = folder_.write("line.wkt", "LINESTRING (0 0, 1 0, 1 2)");
  const v1::SizeField asked = size({.edge = "a + b",
                                    .fields = {parsed("a=distance:marker=5"), parsed("w=width"),
                                               parsed("b=distance:" + lines.string())}});
  ASSERT_EQ(asked.fields_size(), 3);
  EXPECT_EQ(asked.fields(0).name(), "a");
  EXPECT_THAT(asked.fields(0).distance().markers(), ElementsAre(5));
  EXPECT_TRUE(asked.fields(1).has_width());
  EXPECT_THAT(asked.fields(2).distance().points(), ElementsAre(0, 0, 1, 0, 1, 2));
  EXPECT_THAT(asked.fields(2).distance().segments(), ElementsAre(0, 1, 1, 2));
}

TEST_F(Sizes, AreNotOfLinesInAnotherCoordinateSystemThanTheDomain) {
  write_sample_shapefile(folder_ / "d");
  folder_.write("d.prj", R"(GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984"]])");
  const RequestOptions options{.edge = "b",
                               .fields = {parsed("b=distance:" + (folder_ / "d.shp").string())}};
  Domain domain = square_domain(4);
  EXPECT_TRUE(with_size(options, domain)) << "nothing is known of the domain's";
  domain.system = CoordinateSystem{"NAD27", true, "EPSG:4267"};
  EXPECT_TRUE(with_size(options, domain));
  domain.system = CoordinateSystem{"UTM zone 18N", false, "EPSG:32618"};
  const auto refused = with_size(options, domain);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().exit, ExitCode::kUnreadableInput);
  EXPECT_THAT(refused.error().message,
              HasSubstr("d.shp: its coordinate system is 'GCS_WGS_1984', that of the domain is "
                        "'UTM zone 18N'; ogr2ogr -t_srs brings it there"));
}

constexpr char kGrid[] = "title\n1 3\n1 1 1 5\n2 3 1 -2\n3 1 3 40\n1 3 1 2 3\n0\n0\n0\n0\n";

TEST_F(Sizes, BringTheValuesOfAnEarlierMesh) {
  const std::filesystem::path grid = folder_.write("fort.14", kGrid);
  const RequestOptions options{.edge = "d", .fields = {parsed("d=mesh:" + grid.string())}};
  const v1::SizeField asked = size(options);
  ASSERT_EQ(asked.fields_size(), 1);
  EXPECT_EQ(asked.fields(0).name(), "d");
  EXPECT_THAT(asked.fields(0).mesh().vertices(), ElementsAre(1, 1, 3, 1, 1, 3));
  EXPECT_THAT(asked.fields(0).mesh().triangles(), ElementsAre(0, 1, 2));
  EXPECT_THAT(asked.fields(0).mesh().values(), ElementsAre(5, -2, 40));
  EXPECT_THAT(with_size(options, square_domain(4))->warnings, IsEmpty());
}

TEST_F(Sizes, OnAMeshApartFromTheDomainAreWarnedOf) {
  const std::filesystem::path grid = folder_.write("fort.14", kGrid);
  Domain domain = square_domain(4);
  for (Point& point : domain.points) point.x += 10;
  const auto read = with_size({.edge = "d", .fields = {parsed("d=mesh:" + grid.string())}}, domain);
  ASSERT_TRUE(read);
  EXPECT_THAT(read->warnings,
              ElementsAre(grid.string() +
                          ": this mesh lies apart from the domain, from (1, 1) to (3, 3); the "
                          "field d has the values of its boundary"));
}

// A mesh is in what this mesh will be in: degrees, or metres with to_metres.
TEST_F(Sizes, OnAnEarlierMeshAreProjectedAsTheDomainIs) {
  const std::filesystem::path grid = folder_.write("fort.14", kGrid);
  const RequestOptions options{.edge = "d", .fields = {parsed("d=mesh:" + grid.string())}};
  for (const bool to_metres : {false, true}) {
    Domain domain = square_domain(4);
    const auto projection =
        DomainProjection::project(domain, {.lonlat = true, .to_metres = to_metres});
    ASSERT_TRUE(projection) << projection.error().message;
    const auto read = with_size(options, domain, &*projection);
    ASSERT_TRUE(read) << read.error().message;
    const Point first = to_metres ? Point{1, 1} : projection->to_plane({1, 1});
    const auto& vertices = read->asked.size().fields(0).mesh().vertices();
    EXPECT_EQ(vertices[0], first.x);
    EXPECT_EQ(vertices[1], first.y);
  }
}

TEST_F(Sizes, WithoutTheirFilesAreErrors) {
  const auto read =
      with_size({.edge = "a", .fields = {parsed("a=distance:/none.wkt")}}, square_domain(4));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().exit, ExitCode::kUnreadableInput);
}

}  // namespace
}  // namespace weft::client
