// SPDX-License-Identifier: Apache-2.0
// That CalculiX solves on what is written is for tests/python/solve.py to say.
#include "files/formats/meshes/inp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

#include "files/formats/format_names.h"
#include "tests/files/support/mesh_files.h"
#include "tests/files/support/sample_mesh.h"

namespace weft::files {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Mesh with_an_inlet_of_two_edges() {
  Mesh mesh = two_triangles();
  mesh.edge_markers[2] = 2;
  return mesh;
}

class Inp : public ::testing::Test {
 protected:
  std::string written(const Mesh& mesh, int order = 1) {
    std::vector<OutputFile> files;
    files.push_back(OutputFile::create(folder_ / "m.inp", {}).value());
    write_mesh(*mesh_format("m.inp"), mesh.view(), files, {.order = order});
    EXPECT_TRUE(commit(files));
    return contents_of(folder_ / "m.inp");
  }
  Mesh read(const std::string& text) {
    auto mesh = read_mesh(folder_.write("m.inp", text));
    EXPECT_TRUE(mesh) << mesh.error().message;
    return mesh ? std::move(*mesh) : Mesh{};
  }
  std::string refusal(const std::string& text) {
    const auto mesh = read_mesh(folder_.write("m.inp", text));
    if (mesh) return "it was read";
    EXPECT_EQ(mesh.error().exit, ExitCode::kUnreadableInput);
    return mesh.error().message.substr(folder_.path().string().size() + 1);
  }
  TempFolder folder_;
};

constexpr char kSquare[] = "*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 1\n";

std::string square_with(const std::string& text) {
  return kSquare + text;
}

std::vector<std::string> texts_of(const Mesh& mesh) {
  std::vector<std::string> texts;
  for (const Warning& warning : mesh.warnings) texts.push_back(warning.text);
  return texts;
}

TEST_F(Inp, HasRegionsAsElementSetsAndMarkersAsNodeSetsAndSurfaces) {
  EXPECT_EQ(written(with_an_inlet_of_two_edges()),
            "*HEADING\nTriangle mesh of weft\n*NODE\n1, 0, 0\n2, 1, 0\n3, 1, 1\n4, 0, 0.5\n"
            "*ELEMENT, TYPE=CPS3, ELSET=region_-2\n2, 1, 3, 4\n"
            "*ELEMENT, TYPE=CPS3, ELSET=fluid\n1, 1, 2, 3\n"
            "*NSET, NSET=marker_-1\n3, 4\n*SURFACE, NAME=marker_-1, TYPE=ELEMENT\n2, S2\n"
            "*NSET, NSET=the_inlet\n1, 2, 4\n*SURFACE, NAME=the_inlet, TYPE=ELEMENT\n1, S1\n"
            "2, S3\n"
            "*NSET, NSET=inside\n1, 3\n*SURFACE, NAME=inside, TYPE=ELEMENT\n1, S3\n");
}

TEST_F(Inp, OfSecondOrderHasMiddlesBehindCornersAndInNodeSets) {
  const std::string text = written(with_an_inlet_of_two_edges(), 2);
  EXPECT_THAT(text, HasSubstr("5, 0.5, 0\n6, 0.5, 0.5\n7, 0, 0.25\n8, 1, 0.5\n9, 0.5, 0.75\n"));
  EXPECT_THAT(text, HasSubstr("*ELEMENT, TYPE=CPS6, ELSET=fluid\n1, 1, 2, 3, 5, 8, 6\n"));
  EXPECT_THAT(text, HasSubstr("*NSET, NSET=the_inlet\n1, 2, 4, 5, 7\n*SURFACE"));
  EXPECT_THAT(text, HasSubstr("TYPE=ELEMENT\n1, S1\n2, S3\n"));
}

TEST_F(Inp, HasAtMostSixteenNumbersInALine) {
  EXPECT_THAT(written(square_mesh(17)),
              HasSubstr("*NSET, NSET=marker_1\n1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, "
                        "16\n17, 18\n*SURFACE"));
}

// Abaqus and CalculiX read no more of a number.
TEST_F(Inp, HasNumbersOfAtMostTwentyCharacters) {
  Mesh mesh = with_an_inlet_of_two_edges();
  const double nasty[] = {-1.2345678901234567e-05,
                          -1.2345678901234567e-300,
                          -0.0012345678901234567,
                          -1.2345678901234567e+300,
                          -0.12345678901234566,
                          4e6 / 3,
                          1e-5,
                          2.5e-300};
  std::copy(std::begin(nasty), std::end(nasty), mesh.coordinates.begin());
  std::istringstream lines(written(mesh));
  std::string line;
  for (int i = 0; i < 3; ++i) std::getline(lines, line);
  for (std::size_t v = 0; v < 4; ++v) {
    std::getline(lines, line);
    std::istringstream fields(line);
    std::string field;
    std::getline(fields, field, ',');
    for (std::size_t axis = 0; axis < 2; ++axis) {
      std::getline(fields, field, ',');
      EXPECT_LE(field.size(), 21u) << field;  // with the blank
      const double expected = mesh.coordinates[2 * v + axis];
      EXPECT_NEAR(std::stod(field) / expected, 1, 5e-13) << field;
    }
  }
  EXPECT_THAT(contents_of(folder_ / "m.inp"), HasSubstr("3, -0.12345678901234566, "));
}

TEST_F(Inp, ComesBackWithRegionsMarkersAndNames) {
  Mesh mesh = square_mesh(30);
  mesh.edge_markers.front() = -9;
  mesh.edges[2] = mesh.triangles[3];  // inside
  mesh.edges[3] = mesh.triangles[4];
  mesh.names.markers = {{3, "inlet"}};
  mesh.names.regions = {{7, "fluid"}};
  for (const int order : {1, 2}) {
    const Mesh back = read(written(mesh, order));
    EXPECT_EQ(back.coordinates, mesh.coordinates);
    // Elements are in the order of their regions.
    EXPECT_EQ(back.triangles.size(), mesh.triangles.size());
    const auto fluid = id_of(back.names.regions, "fluid");
    const auto inlet = id_of(back.names.markers, "inlet");
    ASSERT_TRUE(fluid && inlet);
    EXPECT_EQ(std::ranges::count(back.regions, *fluid), std::ranges::count(mesh.regions, 7));
    EXPECT_EQ(std::ranges::count(back.regions, 0), std::ranges::count(mesh.regions, 0));
    EXPECT_EQ(back.edges.size(), mesh.edges.size());
    for (const std::int32_t marker : {1, 2, 4, -9})
      EXPECT_EQ(std::ranges::count(back.edge_markers, marker),
                std::ranges::count(mesh.edge_markers, marker))
          << marker;
    EXPECT_EQ(std::ranges::count(back.edge_markers, *inlet),
              std::ranges::count(mesh.edge_markers, 3));
    EXPECT_THAT(back.warnings, IsEmpty());
  }
}

TEST_F(Inp, LabelsAreWordsThatBeginWithALetter) {
  EXPECT_EQ(inp_label("a-b_c9"), "a-b_c9");
  EXPECT_EQ(inp_label("outer wall, w\u00e4nd.2"), "outer_wall__w_nd_2");
  EXPECT_EQ(inp_label("2nd"), "n_2nd");
  EXPECT_EQ(inp_label("_internal"), "n__internal");
  EXPECT_EQ(inp_label("Marker_7"), "n_Marker_7");
  EXPECT_EQ(inp_label(std::string(100, 'x')), std::string(72, 'x'));
}

TEST_F(Inp, LabelsDifferInMoreThanTheCaseOfLetters) {
  Mesh mesh = with_an_inlet_of_two_edges();
  mesh.names.markers = {{2, "Wall"}, {9, "wall"}};
  EXPECT_THAT(not_carried("m.inp", mesh.view()),
              ElementsAre("m.inp: the format cannot spell all names, it has 'wall_2' for 'wall'"));
  EXPECT_THAT(written(mesh), HasSubstr("*NSET, NSET=wall_2\n"));
}

// As Gmsh 4.11 writes it: lines, and the physical groups as further sets.
TEST_F(Inp, ByGmshHasLinesAsEdgesAndGroupsAsSets) {
  const Mesh mesh = read(
      "*Heading\n plate.inp\n*Node\n10, 0., 0., 0\n20, 1.0D+00, 0, 0\n5, 0, 1, 0\n"
      "******* E L E M E N T S *************\n*ELEMENT, type=T3D2, ELSET=Line1\n1, 10, 20\n"
      "2, 20, 5\n*ELEMENT, type=CPS3, ELSET=Surface1\n7, 10, 20, 5\n*ELSET,ELSET=inlet\n1,\n"
      "*ELSET,ELSET=\"the plate\"\n7,\n*NSET,NSET=inlet\n10, 20,\n");
  EXPECT_EQ(mesh.coordinates, (std::vector<double>{0, 0, 1, 0, 0, 1}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh.edges, (std::vector<std::uint32_t>{0, 1, 1, 2}));
  EXPECT_EQ(mesh.edge_markers, (std::vector<std::int32_t>{1, 2}));
  EXPECT_EQ(mesh.names.markers, (NameTable{{1, "inlet"}, {2, "Line1"}}));
  EXPECT_EQ(mesh.names.regions, (NameTable{{1, "the plate"}}));
}

// As Abaqus/CAE writes it: a part, one instance of it, sets in ranges, and internal sets below
// surfaces.
TEST_F(Inp, ByAbaqusHasAPartAndAnInstanceOfIt) {
  const Mesh mesh = read(
      "*Heading\n** Job name: Job-1\n*Part, name=Plate\n" + std::string(kSquare) +
      "*Element, type=CPE3\n1, 1, 2, 3\n 2, 1, 3,\n 4\n*Nset, nset=All, generate\n 1, 4, 1\n"
      "*Elset, elset=Steel, generate\n 1, 2, 1\n** Section: a\n"
      "*Solid Section, elset=Steel, material=Steel\n1.,\n*End Part\n*Assembly, name=Assembly\n"
      "*Instance, name=Plate-1, part=Plate\n 5., 0., 0.\n*End Instance\n*Node\n 1, 9., 9., 0.\n"
      "*Elset, elset=_Load_S2, internal, instance=Plate-1\n 1\n"
      "*Elset, elset=_Load_S3, internal, instance=Plate-1\n 1,\n"
      "*Surface, type=ELEMENT, name=Load\n_Load_S2, S2\n*Surface, name=Other\n"
      "Plate-1._load_s3, S3\n2, S3\n2\n*End Assembly\n*Material, name=Steel\n*Elastic\n2.1e11, "
      "0.3\n"
      "*Step\n*Dsload\nLoad, P, -1.\n*End Step\n");
  EXPECT_EQ(mesh.coordinates, (std::vector<double>{0, 0, 1, 0, 1, 1, 0, 1}));
  EXPECT_EQ(mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(mesh.regions, (std::vector<std::int32_t>{1, 1}));
  EXPECT_EQ(mesh.names.regions, (NameTable{{1, "Steel"}}));
  EXPECT_EQ(mesh.edges, (std::vector<std::uint32_t>{1, 2, 2, 0, 3, 0}));
  EXPECT_EQ(mesh.edge_markers, (std::vector<std::int32_t>{1, 2, 2}));
  EXPECT_EQ(mesh.names.markers, (NameTable{{1, "Load"}, {2, "Other"}}));
  EXPECT_THAT(texts_of(mesh),
              ElementsAre("left out: 1 line of surfaces without a side in the plane"));
}

TEST_F(Inp, RegionIsTheSetOfTheSectionThenTheFirstThatListsTheElement) {
  const Mesh mesh = read(square_with(
      "*ELEMENT, TYPE=CPS3, ELSET=All\n1, 1, 2, 3\n2, 1, 3, 4\n3, 2, 3, 4\n"
      "*ELSET, ELSET=loaded\n1, 2\n*ELSET, ELSET=both\nhalf\n*ELSET, ELSET=half\nboth, 1\n"
      "*SOLID SECTION, ELSET=half, MATERIAL=m\n"));
  EXPECT_EQ(mesh.regions, (std::vector<std::int32_t>{1, 2, 3}));
  EXPECT_EQ(mesh.names.regions, (NameTable{{1, "half"}, {2, "loaded"}, {3, "All"}}));
}

TEST_F(Inp, QuadrilateralsAndSecondOrderAreReadOfEveryFamily) {
  for (const char* type : {"CPS4R", "CPE4RH", "CAX4", "S4R5", "r3d4"}) {
    const Mesh mesh = read(
        square_with("*ELEMENT, TYPE=" + std::string(type) + ", ELSET=REGION_5\n1, 1, 2, 3, 4\n"));
    EXPECT_EQ(mesh.regions, (std::vector<std::int32_t>{5, 5})) << type;
    EXPECT_EQ(mesh.cut_faces, 1u) << type;
  }
  const Mesh mesh = read(
      "*NODE\n1\n2, 2\n3, 2, 2\n4, 0, 2\n5, 1\n6, 2, 1\n7, 1, 2\n8, 0, 1\n9, 4, 0\n10, 4, 2\n"
      "11, 3, 0\n12, 3, 1\n13, 4, 1\n14, 3, 2\n*ELEMENT, TYPE=CPS8\n1, 1, 2, 3, 4,\n5, 6, 7, 8\n"
      "*ELEMENT, TYPE=STRI65\n2, 2, 9, 3, 11, 12, 6\n*ELEMENT, TYPE=CPS6M\n3, 9, 10, 3, 13, 14, "
      "12\n"
      "*ELEMENT, TYPE=B32\n4, 1, 5, 2\n*SURFACE, NAME=faces\n2, S1\n*SURFACE, NAME=top\n3, S2\n1, "
      "S3\n2, E1\n");
  EXPECT_EQ(mesh.coordinates, (std::vector<double>{0, 0, 2, 0, 2, 2, 0, 2, 4, 0, 4, 2}));
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.edges, (std::vector<std::uint32_t>{0, 1, 2, 3, 1, 4, 5, 2}));
  EXPECT_EQ(mesh.edge_markers, (std::vector<std::int32_t>{0, 2, 2, 2}));
}

TEST_F(Inp, ElementsInSpaceAreLeftOutAndCounted) {
  const Mesh mesh = read(square_with(
      "*ELEMENT, TYPE=C3D20R\n1, 1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3,\n4, 1, 2, 3, 4\n"
      "2, 1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3,\n4, 1, 2, 3, 4\n"
      "*ELEMENT, TYPE=CPS3,\n ELSET=a\n1, 1, 2, 3\n*ELEMENT, TYPE=MASS, ELSET=a\n9, 4\n"));
  EXPECT_EQ(mesh.triangles, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(mesh.names.regions, (NameTable{{1, "a"}}));
  EXPECT_THAT(
      texts_of(mesh),
      ElementsAre("left out: 2 elements of the type 'C3D20R', only triangles, quadrilaterals and "
                  "lines are read",
                  "left out: 1 element of the type 'MASS', only triangles, quadrilaterals and "
                  "lines are read"));
}

TEST_F(Inp, RefusesWhatItCannotRead) {
  EXPECT_EQ(refusal("[TITLE]\n"), "m.inp:1:1: expected a keyword such as *NODE, found '[TITLE]'");
  EXPECT_EQ(refusal("** nothing\n*HEADING\nNothing\n"), "m.inp: has no *NODE");
  EXPECT_EQ(refusal("*HEADING\n*Include, input=mesh.inp\n"),
            "m.inp:2:1: '*include' is not read: a mesh is what the file itself lists");
  EXPECT_EQ(refusal("*NODE, INPUT=nodes.txt\n"),
            "m.inp:1:1: the data are in another file, 'nodes.txt': a mesh is what the file itself "
            "lists");
  EXPECT_EQ(refusal("*NODE, SYSTEM=C\n"),
            "m.inp:1:1: the coordinates are of the system 'C', only R is read");
  EXPECT_EQ(refusal("*PART, NAME=a\n*END PART\n*PART, NAME=b\n"),
            "m.inp:3:1: there is a second part, one is read");
  EXPECT_EQ(refusal("*ASSEMBLY\n*INSTANCE, NAME=a\n*END INSTANCE\n*INSTANCE, NAME=b\n"),
            "m.inp:4:1: there is a second instance of a part, one is read");
  EXPECT_EQ(refusal("*NODE\n1, , 2\n"), "m.inp:2:1: there is nothing between two commas");
  EXPECT_EQ(refusal("*NODE\n1, 0, x\n"),
            "m.inp:2:7: expected the y coordinate, a finite number, found 'x'");
  EXPECT_EQ(refusal("*NODE\n1, 0\n1, 1\n"),
            "m.inp:3:1: the node number is 1, as that of another one before it");
  EXPECT_EQ(refusal(square_with("*ELEMENT\n")), "m.inp:6:1: the elements have no TYPE");
  EXPECT_EQ(refusal(square_with("*ELEMENT, TYPE=CPS3\n1, 1, 2, 9\n")),
            "m.inp:7:10: a node of the element is 9, the numbers run from 1 to 4");
  EXPECT_EQ(refusal(square_with("*ELEMENT, TYPE=CPS3\n1, 1, 2\n*STEP\n")),
            "m.inp:8:1: expected a node of the element, found '*STEP'");
  EXPECT_EQ(refusal(square_with("*ELEMENT, TYPE=CPS3\n1, 1, 2, 3, 4\n")),
            "m.inp:7:10: the element has more than the 3 nodes of its type 'CPS3'");
  EXPECT_EQ(refusal(square_with("*ELSET, GENERATE\n")),
            "m.inp:6:1: the set has no name: ELSET is missing");
  EXPECT_EQ(refusal(square_with("*ELSET, ELSET=a\n1x\n")),
            "m.inp:7:1: expected an element or a set, found '1x'");
  EXPECT_EQ(refusal(square_with("*ELSET, ELSET=a, GENERATE\n1, 4, 0\n")),
            "m.inp:7:1: the step is 0, it must be at least 1");
  EXPECT_EQ(refusal(square_with("*ELSET, ELSET=a, GENERATE\n1\n")),
            "m.inp:7:1: expected the first element, the last one and the step");
  EXPECT_EQ(refusal(square_with("*SURFACE, TYPE=ELEMENT\n")), "m.inp:6:1: the surface has no NAME");
}

TEST_F(Inp, RangesOfMoreNumbersThanThereAreElementsTakeNoTime) {
  const Mesh mesh =
      read(square_with("*ELEMENT, TYPE=CPS3\n3, 1, 2, 3\n9000000000000000000, 1, 3, 4\n"
                       "*ELSET, ELSET=a, GENERATE\n-9223372036854775808, 9223372036854775807, 1\n"
                       "*ELSET, ELSET=b, GENERATE\n1, 9223372036854775807, 9223372036854775807\n"));
  EXPECT_EQ(mesh.regions, (std::vector<std::int32_t>{1, 1}));
  EXPECT_EQ(mesh.names.regions, (NameTable{{1, "a"}}));
}

}  // namespace
}  // namespace weft::files
