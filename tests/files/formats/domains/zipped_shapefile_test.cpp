// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/zipped_shapefile.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "files/formats/domain_formats.h"
#include "files/formats/domains/shapefile.h"
#include "tests/files/support/shapefile_writer.h"
#include "tests/files/support/temp_folder.h"
#include "tests/files/support/zip_writer.h"

namespace weft::files {
namespace {

class ZippedShapefile : public ::testing::Test {
 protected:
  ZippedShapefile() { write_sample_shapefile(folder_ / "d"); }

  std::string part(const std::string& extension) const {
    return contents_of(folder_ / ("d" + extension));
  }
  std::string refusal(const std::string& archive) const {
    const auto domain = read_zipped_shapefile(folder_.write("d.zip", archive));
    EXPECT_FALSE(domain);
    return domain ? "" : domain.error().message.substr((folder_ / "").string().size());
  }

  TempFolder folder_;
};

TEST_F(ZippedShapefile, IsReadAsItsFiles) {
  const auto path = folder_.write("d.zip", zip_of({{"read.me", "shapes"},
                                                   {"a/b.c/D.SHP", part(".shp")},
                                                   {"a/b.c/D.dbf", part(".dbf")},
                                                   {"a/D.dbf", "another one"},
                                                   {"a/b.c/D.prj", R"(PROJCS["here"])"},
                                                   {"__MACOSX/a/b.c/._D.shp", "x"}}));
  const auto zipped = read_zipped_shapefile(path);
  ASSERT_TRUE(zipped) << zipped.error().message;
  const auto plain = read_shapefile(folder_ / "d.shp");
  ASSERT_TRUE(plain);
  EXPECT_EQ(zipped->points, plain->points);
  EXPECT_EQ(zipped->segments, plain->segments);
  EXPECT_EQ(zipped->areas, plain->areas);
  EXPECT_EQ(zipped->system->name, "here");
  EXPECT_EQ(zipped->point_places.locate(0), path.string() + ": record 0, ring 0[0]");
  const auto own = read_own_domain(path);
  ASSERT_TRUE(own) << own.error().message;
  EXPECT_EQ(own->points, plain->points);
  const std::string archive = contents_of(path);
  EXPECT_EQ(zipped_shapefile_bytes(archive),
            part(".shp").size() + part(".dbf").size() + std::string(R"(PROJCS["here"])").size());
}

TEST_F(ZippedShapefile, IsUnpackedNowhere) {
  const TempFolder folder;
  ::setenv("TMPDIR", (folder / "none").c_str(), 1);
  EXPECT_TRUE(read_zipped_shapefile(folder_.write("d.zip", zip_of({{"d.shp", part(".shp")}}))));
  EXPECT_EQ(refusal(zip_of({{"d.shp", "x"}})),
            "d.zip: is not a shapefile, or it or the .shx beside it is damaged");
  ::unsetenv("TMPDIR");
}

TEST_F(ZippedShapefile, IsOneAndWhole) {
  EXPECT_EQ(refusal("PK"), "d.zip: is not a zip archive, or it is cut short");
  EXPECT_EQ(refusal(zip_of({{"d.gpkg", "x"}})), "d.zip: holds no shapefile");
  EXPECT_EQ(refusal(zip_of({{"d.shp", "x"}, {"e.shp", "x"}})),
            "d.zip: holds several shapefiles, and one is read");
  EXPECT_EQ(refusal(zip_of({{"d.shp", part(".shp")}, {"d.dbf", "x"}})),
            "d.dbf: is not a dBASE table");
  EXPECT_EQ(zipped_shapefile_bytes("PK"), 0u);
  std::string absurd = zip_of({{"d.shp", "x"}});
  absurd[absurd.rfind("PK\1\2") + 10] = 8;   // deflated
  absurd[absurd.rfind("PK\1\2") + 27] = 64;  // to 1 GiB
  EXPECT_EQ(refusal(absurd), "d.zip: its .shp claims an absurd size");
}

}  // namespace
}  // namespace weft::files
