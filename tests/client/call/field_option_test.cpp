// SPDX-License-Identifier: Apache-2.0
#include "client/call/field_option.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/call/mesh_request.h"
#include "tests/client/support/sample_mesh.h"
#include "tests/client/support/temp_folder.h"

namespace weft::client {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

FieldOption parsed(const std::string& text) {
  return FieldOption::parse(text, "folder").value();
}

std::string fault(const std::string& text) {
  const auto field = FieldOption::parse(text, "folder");
  return field ? "" : field.error();
}

TEST(FieldOption, NamesAKind) {
  EXPECT_EQ(parsed("coast=distance").name, "coast");
  EXPECT_TRUE(std::get<FieldOption::Distance>(parsed("coast=distance").kind).markers.empty());
  EXPECT_THAT(std::get<FieldOption::Distance>(parsed("c=distance:marker=2,-3").kind).markers,
              ElementsAre(2, -3));
  EXPECT_EQ(std::get<FieldOption::DistanceToFile>(parsed("c=distance:a/b.geojson").kind).file,
            "folder/a/b.geojson");
  EXPECT_TRUE(std::holds_alternative<FieldOption::Width>(parsed("w=width").kind));
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

TEST(FieldOption, WithAFaultSaysWhatIsWrong) {
  for (const char* const text : {"coast", "=distance", "coast=", ""})
    EXPECT_THAT(fault(text), HasSubstr("is not NAME=KIND, such as coast=distance")) << text;
  for (const char* const text :
       {"c=distance:marker=", "c=distance:marker=1,", "c=distance:marker=a"})
    EXPECT_THAT(fault(text), HasSubstr("does not list markers, such as marker=2,3")) << text;
  EXPECT_THAT(fault("c=distance:coast.tif"), HasSubstr("'.tif' is not that of a domain"));
}

class Sizes : public testing::Test {
 protected:
  // The size of the request.
  v1::SizeField size(const RequestOptions& options) const {
    const auto read = with_size(options, square_domain(4));
    EXPECT_TRUE(read) << read.error().message;
    return read ? make_request(square_domain(4), *read).size() : v1::SizeField();
  }

  TempFolder folder_;
};

TEST_F(Sizes, MayBeLengthsOfEdges) {
  EXPECT_EQ(size({.edge = "3"}).measure(), v1::MEASURE_EDGE);
  EXPECT_EQ(size({.edge = "3"}).constant(), 3);
  EXPECT_EQ(size({.edge = "x + 1"}).expression(), "x + 1");
  EXPECT_EQ(size({.size = "x + 1"}).measure(), v1::MEASURE_UNSPECIFIED);
  const auto both = with_size({.size = "1", .edge = "1"}, square_domain(4));
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().exit, ExitCode::kUsage);
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

TEST_F(Sizes, WithoutTheirFilesAreErrors) {
  const auto read =
      with_size({.edge = "a", .fields = {parsed("a=distance:/none.wkt")}}, square_domain(4));
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().exit, ExitCode::kUnreadableInput);
}

}  // namespace
}  // namespace weft::client
