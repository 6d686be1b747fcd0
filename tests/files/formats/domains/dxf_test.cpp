// SPDX-License-Identifier: Apache-2.0
#include "files/formats/domains/dxf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "files/formats/domain_formats.h"
#include "tests/files/support/dxf_text.h"
#include "tests/files/support/temp_folder.h"

namespace weft::files {
namespace {

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
            "1 entity of the kind 'REGION', line 74, is not read: it has no lines that weft knows");
}

// The message less the name of the file.
std::string refusal(const std::string& text, const LayerOptions& options = {}) {
  const auto domain = read_dxf_text("d.dxf", text, options);
  EXPECT_FALSE(domain) << text.substr(0, 200);
  if (domain) return "";
  EXPECT_EQ(domain.error().exit, ExitCode::kUnreadableInput);
  return domain.error().message;
}

TEST_F(DxfDrawing, HasTheLayersOfItsEntitiesAsAnAttribute) {
  const std::string lines =
      "0 LINE 5 A 8 inlet 10 0 20 0 11 1 21 0 0 LINE 5 B 8 7 6 DASHED 10 1 20 0 11 1 21 1 "
      "0 LINE 5 C 8 wall 6 DASHED 10 1 20 1 11 0 21 0 ";
  const Domain all = read(lines, {.layers = {"entities"}, .attributes = {{"marker", "layer"}}});
  ASSERT_EQ(all.segments.size(), 3u);
  EXPECT_EQ(all.segments[1].marker, 7);
  EXPECT_EQ(all.names.markers,
            (NameTable{{all.segments[0].marker, "inlet"}, {all.segments[2].marker, "wall"}}));
  EXPECT_EQ(read(lines, {.where = "linetype = 'Dashed'"}).segments.size(), 2u);
  EXPECT_EQ(read(lines, {.where = "EntityHandle IN ('A', 'C')"}).segments.size(), 2u);
  EXPECT_EQ(read(lines, {.where = "Linetype IS NULL"}).segments.size(), 1u);
  EXPECT_EQ(refusal(drawing(lines), {.layers = {"wall"}}),
            "d.dxf: has no layer 'wall'; there are 'entities', whose attribute Layer says on which "
            "layer each is drawn");
  EXPECT_EQ(refusal(drawing(lines), {.attributes = {{"marker", "Colour"}}}),
            "d.dxf: has no attribute 'Colour'; there are 'Layer', 'PaperSpace', 'SubClasses', "
            "'Linetype', 'EntityHandle', 'Text'");
  EXPECT_EQ(refusal(drawing(lines), {.where = "Colour = 3"}),
            "d.dxf: layer 'entities', --where 'Colour = 3' cannot be read: there is no attribute "
            "'Colour'");
  EXPECT_EQ(refusal(drawing(lines), {.where = "Layer = 'x'"}), "d.dxf: holds no geometry");
}

TEST_F(DxfDrawing, HasNamesInItsCodePage) {
  std::string text = drawing("0 LINE 8 W\xe4nde 10 0 20 0 11 1 21 0 ");
  text.replace(text.find("9\n$ACADVER"), 10, "9\n$DWGCODEPAGE\n3\nANSI_1252\n9\n$ACADVER");
  const auto domain = read_dxf_text("d.dxf", text, {.attributes = {{"marker", "Layer"}}});
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->names.markers, (NameTable{{1, "W\u00e4nde"}}));
}

TEST_F(DxfDrawing, IsReadWithAnyLineEndsAndWithoutAHeader) {
  const std::string lines =
      "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\n\n10\n0\n20\n0\n11\n4\n21\n0\n0\n"
      "ENDSEC\n";
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char c : lines + "0\nEOF")
      if (c == '\n')
        text += end;
      else
        text += c;
    const auto domain = read_dxf_text("d.dxf", text, {});
    ASSERT_TRUE(domain) << domain.error().message;
    EXPECT_EQ(domain->segments.size(), 1u);
  }
  for (const std::string around : {"999\nplate\n", "\xef\xbb\xbf"})
    EXPECT_TRUE(read_dxf_text("d.dxf", around + lines, {}));
}

TEST_F(DxfDrawing, IsRefusedWithThePlaceOfWhatIsNone) {
  EXPECT_EQ(refusal("<xml>"), "d.dxf:1: expected the code of a group, found '<xml>'");
  EXPECT_EQ(refusal(""), "d.dxf: is no drawing in DXF: it has no section ENTITIES");
  EXPECT_EQ(refusal("0\nSECTION\n2\nENTITIES\n0\nLINE\n10\n"),
            "d.dxf:7: expected a value after the code 10, found the end of the file");
  EXPECT_EQ(refusal("0\nSECTION\n2\nENTITIES\n0\nLINE\n"),
            "d.dxf:6: expected ENDSEC of the section 'ENTITIES', found the end of the file");
  EXPECT_EQ(refusal("0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nB\n"),
            "d.dxf:8: expected ENDBLK of a block, found the end of the file");
  EXPECT_EQ(refusal("0\nSECTION\n2\nENTITIES\n0\nLINE\n10\n1,5\n0\nENDSEC\n"),
            "d.dxf:8: expected a number in group 10, found '1,5'");
  EXPECT_EQ(refusal("0\nSECTION\n2\nENTITIES\n0\nLWPOLYLINE\n70\nx\n0\nENDSEC\n"),
            "d.dxf:8: expected a whole number in group 70, found 'x'");
  EXPECT_EQ(refusal(drawing("0 LINE 8 0 10 1e60 20 0 11 0 21 0 ")),
            "d.dxf: layer 'entities', feature 0 on '0'[0] is (1e+60, 0), magnitudes go up to 1e50");
  for (const char* number : {"nan", "inf", "1e999"})
    EXPECT_EQ(refusal(drawing("0 CIRCLE 8 0 10 0 20 0 40 " + std::string(number) + " ")),
              "d.dxf:54: expected a number in group 40, found '" + std::string(number) + "'");
  EXPECT_EQ(refusal("AutoCAD Binary DXF\r\n\x1a"),
            "d.dxf: is a DXF in binary form; save it as a DXF in text form (ASCII)");
  EXPECT_EQ(refusal("AC1027"), "d.dxf: is a DWG, not a DXF; save it as a DXF in text form (ASCII)");
  EXPECT_EQ(refusal(drawing(kText)), "d.dxf: holds no geometry");
}

TEST_F(DxfDrawing, IsRefusedIfItsBlocksPlaceTooMuch) {
  const auto block = [](const std::string& name, const std::string& content) {
    return "0 BLOCK 2 " + name + " 10 0 20 0 " + content + "0 ENDBLK ";
  };
  const std::string thousand = " 70 10 71 100 44 1 45 1 10 0 20 0 ";
  const std::string of_lines = block("a", "0 LINE 10 0 20 0 11 1 21 0 ");
  const std::string bomb =
      of_lines + block("b", "0 INSERT 2 a" + thousand) + block("c", "0 INSERT 2 b" + thousand);
  EXPECT_TRUE(refusal(drawing("0 INSERT 2 c" + thousand, bomb))
                  .ends_with("expected blocks that place at most 5,000,000 groups and positions, "
                             "found more at this INSERT"));
  EXPECT_TRUE(refusal(drawing("0 INSERT 2 a 70 2000000000 71 2000000000 ", block("a", "")))
                  .ends_with("found more at this INSERT"));
  EXPECT_TRUE(refusal(drawing("0 INSERT 2 a ", block("a", "0 INSERT 2 A ")))
                  .ends_with(": expected blocks that are nested at most 64 levels deep, found more "
                             "at this INSERT"));
  EXPECT_EQ(warning(read(kPlate + "0 INSERT 2 none 10 0 20 0 ")),
            "1 entity of the kind 'INSERT', line 74, is left out: of a block that is not in the "
            "file");
}

}  // namespace
}  // namespace weft::files
