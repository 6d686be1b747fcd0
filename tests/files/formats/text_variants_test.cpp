// SPDX-License-Identifier: Apache-2.0
// Domains in text of every format, as editors and programs of any system save it: the same domain.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "files/formats/domain_formats.h"
#include "files/formats/raster.h"
#include "tests/files/support/mesh_files.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

using Change = std::string (*)(const std::string&);

std::string replaced(const std::string& text, const std::string& from, const std::string& to) {
  std::string out;
  std::size_t at = 0;
  for (std::size_t next; (next = text.find(from, at)) != std::string::npos; at = next + from.size())
    out += text.substr(at, next - at) + to;
  return out + text.substr(at);
}

// Tabs between fields, not in names or comments.
std::string with_tabs(const std::string& text) {
  std::string out = text;
  bool quoted = false;
  bool comment = false;
  for (char& c : out) {
    quoted ^= c == '"';
    comment = c != '\n' && (comment || c == '#');
    if (c == ' ' && !quoted && !comment) c = '\t';
  }
  return out;
}

// Blanks at the ends of lines, but of a comment that ends in a name.
std::string with_blanks_at_the_ends(const std::string& text) {
  return replaced(replaced(text, "\n", " \t\n"), "inlet \t\n", "inlet\t\n");
}

// ASCII alone.
std::string utf16(const std::string& text, bool big) {
  std::string out = big ? "\xfe\xff" : "\xff\xfe";
  for (const char c : text) {
    if (big) out += '\0';
    out += c;
    if (!big) out += '\0';
  }
  return out;
}

struct Variant {
  const char* name;
  Change change;
};

const Variant kVariants[] = {
    {"ByteOrderMark", [](const std::string& t) { return "\xef\xbb\xbf" + t; }},
    {"Utf16Little", [](const std::string& t) { return utf16(t, false); }},
    {"Utf16Big", [](const std::string& t) { return utf16(replaced(t, "\n", "\r\n"), true); }},
    {"CarriageReturnAndLineFeed", [](const std::string& t) { return replaced(t, "\n", "\r\n"); }},
    {"CarriageReturn", [](const std::string& t) { return replaced(t, "\n", "\r"); }},
    {"TranslatedTwice", [](const std::string& t) { return replaced(t, "\n", "\r\r\n"); }},
    {"Tabs", with_tabs},
    {"BlanksAtTheEnds", with_blanks_at_the_ends},
    {"NoLastLineEnd",
     [](const std::string& t) { return t.substr(0, t.find_last_not_of('\n') + 1); }},
    {"BlankLinesAtTheEnd", [](const std::string& t) { return t + "\n \n\r\n"; }},
};

const std::string kPoly =
    "4 2 0 0\n1 0 0\n2 4 0\n3 4 3\n4 0 3\n4 1\n1 1 2 5\n2 2 3 5\n3 3 4 6\n4 4 1 6\n0\n1\n"
    "1 1 1 7 0.5\n# marker=5:inlet\n";

void write_all(const TempFolder& folder, const char* name) {
  Mesh mesh = square_mesh(3);
  mesh.names.markers = {{1, "inlet"}};
  std::vector<OutputFile> files;
  for (const auto& file : mesh_files(folder / name))
    files.push_back(std::move(OutputFile::create(file, {}).value()));
  write_mesh(*mesh_format(folder / name), mesh.view(), files, {.msh_version = MshVersion::k22});
  ASSERT_TRUE(commit(files));
}

void write_sample(const TempFolder& folder, const std::string& name) {
  if (name == "d.poly") {
    folder.write(name, kPoly);
  } else if (name == "d.geojson" || name == "d.json") {
    folder.write(name, R"({"type": "Feature", "properties": {"marker": "wall", "region": 7},
"geometry": {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 3], [0, 0]]]}}
)");
  } else if (name == "d.wkt") {
    folder.write(name,
                 "POLYGON ((0 0, 4 0, 4 3, 0 0),\n (1 1, 2 1, 1 2, 1 1));\nLINESTRING(0 0, 1 1)\n");
  } else if (name == "d.csv") {
    folder.write(name, "x y marker\n0 0 1\n9 0 2\n9 9 west\n\n1 1 3\n2 1 3\n2 2 3\n");
  } else if (name == "features.csv") {
    folder.write(name, "WKT;region\nPOLYGON ((0 0,4 0,4 3,0 0));bay\n");
  } else {
    write_all(folder, name == "m.ele" ? "m.node" : name.c_str());
  }
}

class TextVariant : public ::testing::TestWithParam<std::tuple<const char*, std::size_t>> {};

TEST_P(TextVariant, IsTheSameDomain) {
  const std::string name = std::get<0>(GetParam());
  const Variant& variant = kVariants[std::get<1>(GetParam())];
  TempFolder folder;
  write_sample(folder, name);
  const auto expected = read_domain(folder / name);
  ASSERT_TRUE(expected) << expected.error().message;
  for (const std::string& file : folder.names())
    folder.write(file, variant.change(contents_of(folder / file)));
  const auto domain = read_domain(folder / name);
  ASSERT_TRUE(domain) << variant.name << ": " << domain.error().message;
  EXPECT_EQ(domain->points, expected->points);
  EXPECT_EQ(domain->point_markers, expected->point_markers);
  EXPECT_EQ(domain->segments, expected->segments);
  EXPECT_EQ(domain->holes, expected->holes);
  EXPECT_EQ(domain->regions, expected->regions);
  EXPECT_EQ(domain->names, expected->names);
  EXPECT_EQ(domain->fill, expected->fill);
  EXPECT_EQ(domain->warnings, expected->warnings);
}

INSTANTIATE_TEST_SUITE_P(
    Formats, TextVariant,
    ::testing::Combine(::testing::Values("d.poly", "d.geojson", "d.json", "d.wkt", "d.csv",
                                         "features.csv", "m.node", "m.ele", "m.14", "m.grd",
                                         "m.gr3", "m.2dm", "m.su2", "m.mesh", "m.msh", "m.obj",
                                         "m.off", "m.vol", "m.mfem", "m.inp"),
                       ::testing::Range(std::size_t{0}, std::size(kVariants))),
    [](const auto& info) {
      std::string name = std::get<0>(info.param);
      std::replace(name.begin(), name.end(), '.', '_');
      return name + "_" + kVariants[std::get<1>(info.param)].name;
    });

TEST(TextVariant, OfARasterIsTheSameRaster) {
  TempFolder folder;
  const std::string text = "ncols 2\nnrows 2\nxllcorner 1\nyllcorner 2\ncellsize 3\n1 2\n3 4\n";
  const auto expected = read_raster(folder.write("d.asc", text));
  ASSERT_TRUE(expected) << expected.error().message;
  for (const Variant& variant : kVariants) {
    const auto raster = read_raster(folder.write("d.asc", variant.change(text)));
    ASSERT_TRUE(raster) << variant.name << ": " << raster.error().message;
    EXPECT_EQ(raster->values, expected->values) << variant.name;
    EXPECT_EQ(raster->x, expected->x) << variant.name;
  }
}

// Files that are no more than the beginning of a text.
TEST(TextVariant, WithoutTextIsRefusedAndSaysSo) {
  using namespace std::string_literals;
  TempFolder folder;
  for (const char* name : {"d.poly", "d.geojson", "d.wkt", "d.csv", "m.14", "m.2dm", "m.su2",
                           "m.mesh", "m.msh", "m.obj", "m.off", "m.vol", "m.mfem", "m.inp"}) {
    for (const std::string& bytes : {""s, "\xef\xbb\xbf"s, "\xff\xfe"s, "\xfe\xff"s, "\xff\xfe\n"s,
                                     "\xff\xfe\x00\xd8"s, "\xfe\xff\xdc\x00\xdc\x00"s}) {
      const auto path = folder.write(name, bytes);
      const auto domain = read_domain(path);
      if (std::string_view(name) == "m.obj" && domain) continue;  // an empty mesh
      ASSERT_FALSE(domain) << name;
      EXPECT_TRUE(domain.error().message.starts_with(path.string() + ":"))
          << domain.error().message;
    }
  }
}

// Numbers in exponents as Fortran writes them.
TEST(TextVariant, OfFortranHasTheSameNumbers) {
  TempFolder folder;
  const std::pair<const char*, const char*> kSamples[] = {
      {"d.poly", "3 2 0 0\n1 0.0D+00 0\n2 4.0D+03 0.0d0\n3 0 3.0+103\n3\n1 1 2\n2 2 3\n3 3 1\n0\n"},
      {"d.wkt", "POLYGON((0 0.0D+00, 4.0D+03 0.0d0, 0 3.0+103, 0 0))"},
      {"d.csv", "0.0D+00 0\n4.0D+03 0.0d0\n0 3.0+103\n"},
      {"d.14", "title\n1 3\n1 0.0D+00 0 0\n2 4.0D+03 0.0d0 0\n3 0 3.0+103 0\n1 3 1 2 3\n"},
      {"d.gr3", "title\n1 3\n1 0.0D+00 0 0\n2 4.0D+03 0.0d0 0\n3 0 3.0+103 0\n1 3 1 2 3\n"},
      {"d.2dm",
       "MESH2D\nND 1 0.0D+00 0 0\nND 2 4.0D+03 0.0d0 0\nND 3 0 3.0+103 0\nE3T 1 1 2 3 1\n"},
      {"d.su2", "NDIME= 2\nNELEM= 1\n5 0 1 2\nNPOIN= 3\n0.0D+00 0\n4.0D+03 0.0d0\n0 3.0+103\n"},
      {"d.msh",
       "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0.0D+00 0 0\n2 4.0D+03 0.0d0 0\n3 "
       "0 3.0+103 0\n$EndNodes\n$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n"},
      {"d.obj", "v 0.0D+00 0 0\nv 4.0D+03 0.0d0 0\nv 0 3.0+103 0\nf 1 2 3\n"},
      {"d.inp",
       "*NODE\n1, 0.0D+00, 0\n2, 4.0D+03, 0.0d0\n3, 0, 3.0+103\n*ELEMENT, TYPE=CPS3\n1, 1, 2, 3\n"},
      {"d.off", "OFF\n3 1 0\n0.0D+00 0 0\n4.0D+03 0.0d0 0\n0 3.0+103 0\n3 0 1 2\n"},
  };
  for (const auto& [name, text] : kSamples) {
    const bool is_geometry = std::string_view(name) == "d.wkt" || std::string_view(name) == "d.csv";
    std::string fits(text);  // geometries go up to 1e50
    if (is_geometry) fits = replaced(fits, "3.0+103", "0.3D+001");
    const auto domain = read_domain(folder.write(name, fits));
    ASSERT_TRUE(domain) << domain.error().message;
    EXPECT_EQ(domain->points, (std::vector<Point>{{0, 0}, {4000, 0}, {0, is_geometry ? 3 : 3e103}}))
        << name;
  }
}

}  // namespace
}  // namespace weft::files
