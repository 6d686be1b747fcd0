// SPDX-License-Identifier: Apache-2.0
#include "files/formats/derived/faces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/files/support/mesh_files.h"

namespace weft::files {
namespace {

// The area of the triangles, each counted as positive.
double area(const std::vector<std::uint32_t>& triangles, const std::vector<double>& at) {
  double sum = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const double* a = &at[2 * triangles[t]];
    const double* b = &at[2 * triangles[t + 1]];
    const double* c = &at[2 * triangles[t + 2]];
    sum += std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2;
  }
  return sum;
}

TEST(Faces, CoverWhatTheyBound) {
  const std::vector<double> square = {0, 0, 2, 0, 2, 2, 0, 2};
  EXPECT_EQ(area(cut_face(std::vector<std::uint32_t>{0, 1, 2, 3}, square), square), 4);
  EXPECT_EQ(area(cut_face(std::vector<std::uint32_t>{3, 2, 1, 0}, square), square), 4);
  // An arrowhead, from each corner, in both directions.
  const std::vector<double> arrow = {0, 0, 4, 0, 1, 1, 0, 4};
  for (std::uint32_t first = 0; first < 4; ++first) {
    std::vector<std::uint32_t> corners;
    for (std::uint32_t k = 0; k < 4; ++k) corners.push_back((first + k) % 4);
    EXPECT_EQ(area(cut_face(corners, arrow), arrow), 4) << first;
    std::reverse(corners.begin(), corners.end());
    EXPECT_EQ(area(cut_face(corners, arrow), arrow), 4) << first;
  }
  // The letter U.
  const std::vector<double> u = {0, 0, 3, 0, 3, 3, 2, 3, 2, 1, 1, 1, 1, 3, 0, 3};
  EXPECT_EQ(area(cut_face(std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7}, u), u), 7);
}

TEST(Faces, ThatRepeatACornerAreTriangles) {
  const std::vector<double> square = {0, 0, 2, 0, 2, 2, 0, 2};
  EXPECT_EQ(cut_face(std::vector<std::uint32_t>{0, 1, 2, 2}, square).size(), 3u);
  EXPECT_EQ(cut_face(std::vector<std::uint32_t>{0, 1, 2, 0}, square).size(), 3u);
  EXPECT_TRUE(cut_face(std::vector<std::uint32_t>{0, 1, 1, 0}, square).empty());
}

struct File {
  const char* name;
  std::string text;
};

// A square of 2 as one quadrilateral, and a triangle beside it, in every format that may hold one.
class QuadrilateralFile : public ::testing::TestWithParam<File> {};

TEST_P(QuadrilateralFile, IsReadAsTriangles) {
  const TempFolder folder;
  const auto mesh = read_mesh(folder.write(GetParam().name, GetParam().text));
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 9u);
  EXPECT_EQ(mesh->regions.size(), 3u);
  EXPECT_EQ(area(mesh->triangles, mesh->coordinates), 5);
  EXPECT_EQ(mesh->cut_faces, 1u);
}

INSTANTIATE_TEST_SUITE_P(
    Of, QuadrilateralFile,
    ::testing::Values(
        File{"q.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 3 1 0\nf 1 2 3 4\nf 2 5 3\n"},
        File{"q.off", "OFF\n5 2 0\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n3 1 0\n4 0 1 2 3\n3 1 4 2\n"},
        File{"c.off",
             "COFF\n5 2 0\n0 0 0 9 9 9 9\n2 0 0 9 9 9 9\n2 2 0 9 9 9 9\n0 2 0 9 9 9 9\n"
             "3 1 0 9 9 9 9\n4 0 1 2 3 255 0 0\n3 1 4 2\n"},
        File{"n.off",
             "STCNOFF 5 2 0\n0 0 0 0 0 1\n2 0 0 0 0 1\n2 2 0 0 0 1\n0 2 0 0 0 1\n3 1 0 0 0 1\n"
             "4 0 1 2 3\n3 1 4 2\n"},
        File{"q.gr3",
             "q\n2 5\n1 0 0 1\n2 2 0 1\n3 2 2 1\n4 0 2 1\n5 3 1 1\n1 4 1 2 3 4\n"
             "2 3 2 5 3\n"},
        File{"q.2dm",
             "MESH2D\nE4Q 1 1 2 3 4 1\nE3T 2 2 5 3 1\nND 1 0 0 nan\nND 2 2 0 1\n"
             "ND 3 2 2 1\nND 4 0 2 1\nND 5 3 1 1\n"},
        File{"q.su2",
             "NDIME= 2\nNELEM= 2\n9 0 1 2 3 0\n5 1 4 2 1\nNPOIN= 5\n0 0\n2 0\n2 2\n0 2\n"
             "3 1\n"},
        File{"q.mesh",
             "MeshVersionFormatted 2\nDimension 2\nVertices 5\n0 0 0\n2 0 0\n2 2 0\n"
             "0 2 0\n3 1 0\nQuadrilaterals 1\n1 2 3 4 7\nTriangles 1\n2 5 3 7\nEnd\n"},
        File{"q.mfem",
             "MFEM mesh v1.0\ndimension\n2\nelements\n2\n1 3 0 1 2 3\n1 2 1 4 2\n"
             "boundary\n0\nvertices\n5\n2\n0 0\n2 0\n2 2\n0 2\n3 1\n"},
        File{"q.vol",
             "mesh3d\ndimension\n2\nsurfaceelements\n2\n1 1 1 0 4 1 2 3 4\n"
             "1 1 1 0 3 2 5 3\npoints\n5\n0 0 0\n2 0 0\n2 2 0\n0 2 0\n3 1 0\nendmesh\n"},
        File{"q.msh",
             "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 2 0 0\n3 2 2 0\n"
             "4 0 2 0\n5 3 1 0\n$EndNodes\n$Elements\n2\n1 3 2 1 1 1 2 3 4\n"
             "2 2 2 1 1 2 5 3\n$EndElements\n"}),
    [](const auto& info) {
      std::string name = info.param.name;
      std::replace(name.begin(), name.end(), '.', '_');
      return name;
    });

TEST(Faces, WithACornerThatIsMissingAreRefused) {
  const TempFolder folder;
  const auto mesh = read_mesh(
      folder.write("q.su2", "NDIME= 2\nNELEM= 1\n9 0 1 2 9 0\nNPOIN= 4\n0 0\n2 0\n2 2\n0 2\n"));
  ASSERT_FALSE(mesh);
  EXPECT_TRUE(mesh.error().message.ends_with("face 0 of more than three corners has vertex 9 of 4"))
      << mesh.error().message;
}

}  // namespace
}  // namespace weft::files
