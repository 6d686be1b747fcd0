// SPDX-License-Identifier: Apache-2.0
#include "client/formats/domains/ogr_dxf.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include "client/formats/domain_formats.h"
#include "tests/client/support/temp_folder.h"

namespace weft::client {
namespace {

// A drawing of these entities, pairs of a code and a value in one string.
std::string drawing(const std::string& entities, const std::string& blocks = "") {
  std::string text;
  for (const char c :
       "0 SECTION 2 HEADER 9 $ACADVER 1 AC1015 0 ENDSEC 0 SECTION 2 TABLES 0 TABLE 2 LAYER 70 1 0 "
       "LAYER 2 0 70 0 62 7 6 CONTINUOUS 0 ENDTAB 0 ENDSEC 0 SECTION 2 BLOCKS " +
           blocks + "0 ENDSEC 0 SECTION 2 ENTITIES " + entities + "0 ENDSEC 0 EOF ")
    text += c == ' ' ? '\n' : c;
  return text;
}

const std::string kPlate =
    "0 LWPOLYLINE 5 2A 8 CUT 100 AcDbPolyline 90 4 70 1 10 0 20 0 10 4 20 0 10 4 20 2 10 0 20 2 ";
const std::string kCircle = "0 CIRCLE 5 2B 8 HOLES 10 2 20 1 40 0.5 ";
const std::string kText = "0 TEXT 8 TXT 10 1 20 1 40 0.1 1 A ";
const std::string kHatch =
    "0 HATCH 5 2C 8 H 10 0.0 20 0.0 30 0.0 210 0.0 220 0.0 230 1.0 2 SOLID 70 1 71 0 91 1 92 3 72 "
    "0 "
    "73 1 93 4 10 1 20 0.5 10 2 20 0.5 10 2 20 1.5 10 1 20 1.5 97 0 75 0 76 1 98 0 ";

class DxfDrawing : public ::testing::Test {
 protected:
  Domain read(const std::string& entities, const LayerOptions& options = {},
              const std::string& blocks = "") {
    const auto domain = read_domain(folder_.write("d.dxf", drawing(entities, blocks)), options);
    EXPECT_TRUE(domain) << domain.error().message;
    return domain ? *domain : Domain{};
  }
  // Less the name of the file.
  std::string warning(const Domain& domain) const {
    EXPECT_EQ(domain.warnings.size(), 1u);
    return domain.warnings.empty()
               ? ""
               : domain.warnings[0].sentence().substr((folder_ / "d.dxf: ").string().size());
  }
  TempFolder folder_;
};

TEST_F(DxfDrawing, IsWithoutWhatIsSaidAboutIt) {
  for (const std::string& note :
       {kText, std::string("0 MTEXT 8 T 10 1 20 1 40 0.1 1 A "),
        std::string(
            "0 DIMENSION 8 DIM 100 AcDbDimension 2 *D1 10 4 20 2.5 11 2 21 2.5 70 32 1  100 "
            "AcDbAlignedDimension 13 0 23 2 14 4 24 2 "),
        std::string("0 LEADER 8 L 3 STANDARD 71 1 72 0 73 3 76 2 10 0 20 2 10 1 20 3 "),
        std::string("0 MULTILEADER 8 L 100 AcDbMLeader 270 2 300 CONTEXT_DATA{ 301 } "),
        std::string("0 VIEWPORT 67 1 8 0 10 1 20 1 40 9 41 9 69 1 "),
        std::string("0 ATTDEF 8 T 10 1 20 1 40 0.1 1 A 2 TAG 3 ? 70 0 ")}) {
    const Domain domain = read(note + kPlate + note, {},
                               "0 BLOCK 8 0 2 *D1 70 1 10 0 20 0 3 *D1 1  0 LINE 8 0 10 0 20 2 11 "
                               "0 21 2.6 0 LINE 8 0 10 0 "
                               "20 2.5 11 4 21 2.5 0 ENDBLK 8 0 ");
    EXPECT_EQ(domain.points.size(), 5u) << note;
    EXPECT_EQ(domain.segments.size(), 4u) << note;
    EXPECT_TRUE(domain.warnings.empty()) << note;
  }
}

TEST_F(DxfDrawing, HasBlocksWithoutTheirAttributes) {
  const Domain domain =
      read(kPlate +
               "0 INSERT 8 0 66 1 2 B 10 1 20 1 0 ATTRIB 8 0 10 3 20 1 40 0.1 1 X 2 TAG 70 0 0 "
               "SEQEND 8 0 ",
           {},
           "0 BLOCK 8 0 2 B 70 0 10 0 20 0 3 B 1  0 LINE 8 0 10 0 20 0 11 1 21 0 0 TEXT 8 0 10 0 "
           "20 0 40 0.1 1 A 0 ENDBLK 8 0 ");
  EXPECT_EQ(domain.segments.size(), 5u);
  EXPECT_EQ(domain.points.size(), 7u);
}

TEST_F(DxfDrawing, IsBoundedByItsLinesAndNotByItsHatches) {
  const Domain domain = read(kPlate + kHatch);
  EXPECT_EQ(domain.segments.size(), 4u);
  EXPECT_TRUE(domain.areas.empty());
  EXPECT_EQ(warning(domain),
            "1 filled area (hatch, solid or face) is left out: layer 'entities', feature 1 on 'H', "
            "handle 2C; lines bound what is meshed; without lines, as --where can choose, such "
            "areas are");
  EXPECT_EQ(read(kHatch).areas.size(), 1u);
  EXPECT_EQ(read(kPlate + kHatch, {.where = "Layer = 'H'"}).areas.size(), 1u);
}

TEST_F(DxfDrawing, TellsOfAnOutlineInAnother) {
  EXPECT_EQ(
      warning(read(kPlate + kCircle)),
      "1 closed outline lies inside another one and is filled: layer 'entities', feature 1 on "
      "'HOLES', handle 2B; --fill even-odd makes holes of them");
  EXPECT_TRUE(read(kPlate + kCircle, {.even_odd = true}).warnings.empty());
  EXPECT_TRUE(read(kPlate).warnings.empty());
  // The plate as four lines, one of which goes on.
  EXPECT_EQ(warning(read("0 LINE 8 0 10 0 20 0 11 9 21 0 0 LINE 8 0 10 4 20 0 11 4 21 2 0 LINE 8 0 "
                         "10 4 20 2 11 0 21 2 0 LINE 8 0 10 0 20 2 11 0 21 0 " +
                         kCircle))
                .substr(0, 16),
            "1 closed outline");
  EXPECT_TRUE(read(kPlate + "0 CIRCLE 8 0 10 8 20 1 40 0.5 0 LINE 8 0 10 6 20 0 11 6 21 2 ")
                  .warnings.empty());
}

TEST_F(DxfDrawing, TellsOfARegionThatItsLinesCannotHave) {
  EXPECT_EQ(
      warning(read(kPlate, {.attributes = {{"region", "Layer"}}})),
      "layer 'entities', feature 0 on 'CUT', handle 2A is a line, and has a region or a bound "
      "on triangles as if it were a polygon: there are no polygons, so these have no effect");
}

TEST_F(DxfDrawing, IsThatOfTheModelUnlessAllIsOnPaper) {
  const std::string frame = "0 LINE 67 1 8 0 10 -9 20 -9 11 99 21 -9 ";
  const Domain model = read(kPlate + frame);
  EXPECT_EQ(model.segments.size(), 4u);
  EXPECT_EQ(warning(model),
            "1 entity of the kind 'LINE', line 74, is left out: on paper, not in the model");
  EXPECT_EQ(read(frame).segments.size(), 1u);
}

TEST_F(DxfDrawing, NamesWhatIsNotRead) {
  EXPECT_EQ(warning(read(kPlate + "0 REGION 5 2D 8 0 100 AcDbModelerGeometry 70 1 1 xyz ")),
            "1 entity of the kind 'REGION', line 74, is not read: it has no lines that GDAL knows");
}

TEST_F(DxfDrawing, IsTheSameWhateverTheEnvironmentAsksOfGdal) {
  const std::size_t segments = read(kCircle).segments.size();
  EXPECT_NEAR(static_cast<double>(segments), 90, 2);
  for (const auto& [name, value] : {std::pair{"OGR_ARC_STEPSIZE", "45"},
                                    {"OGR_ARC_MAX_GAP", "0.5"},
                                    {"DXF_CLOSED_LINE_AS_POLYGON", "TRUE"},
                                    {"DXF_INLINE_BLOCKS", "FALSE"}}) {
    ::setenv(name, value, 1);
    const Domain domain = read(kCircle);
    ::unsetenv(name);
    EXPECT_EQ(domain.segments.size(), segments) << name;
    EXPECT_TRUE(domain.areas.empty()) << name;
  }
}

TEST(DxfModel, LeavesWhatIsNoDrawingAsItIs) {
  for (const char* text : {"", "<xml>", "0\nSECTION", "x\ny\nz\n"})
    EXPECT_TRUE(dxf_model(text).text.ends_with(text)) << text;
  EXPECT_EQ(dxf_model("0\r\nSECTION\r\n2\r\nHEADER\r\n0\r\nENDSEC\r\n").text,
            "0\r\nSECTION\r\n2\r\nHEADER\r\n0\r\nENDSEC\r\n");
  const std::string with_name = "0\nSECTION\n2\nHEADER\n9\n$UCSNAME\n2\n\n0\nENDSEC\n";
  EXPECT_EQ(dxf_model(with_name).text, with_name);
}

}  // namespace
}  // namespace weft::client
