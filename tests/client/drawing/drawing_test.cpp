// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/draw.h"

#include <cairo.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "client/drawing/colors.h"
#include "tests/client/support/sample_mesh.h"
#include "tests/client/support/temp_folder.h"

namespace weft::client {
namespace {

class DrawingTest : public testing::Test {
 protected:
  struct Options {
    DrawColor color = DrawColor::kNone;
    std::uint32_t long_side = 1800;
    std::vector<double> boxes = {};
    std::size_t pieces = 1;
  };
  std::filesystem::path draw_to(const std::string& name, const Mesh& mesh, const Options& options) {
    std::vector<OutputFile> files;
    files.push_back(std::move(OutputFile::create(folder_ / name, {}).value()));
    Drawing drawing({.color = options.color, .pixels = options.long_side, .no_legend = true});
    const std::size_t triangles = mesh.triangles.size() / 3;
    for (std::size_t p = 0; p < options.pieces; ++p) {
      const std::size_t first = triangles * p / options.pieces;
      const std::size_t count = triangles * (p + 1) / options.pieces - first;
      MeshView piece = mesh.view();
      piece.triangles = piece.triangles.subspan(3 * first, 3 * count);
      piece.regions = piece.regions.subspan(first, count);
      if (p > 0) piece.edges = {};
      drawing.add(piece);
    }
    const auto drawn = drawing.draw(draw_format(name).value(), options.boxes, files[0]);
    EXPECT_TRUE(drawn) << drawn.error().message;
    EXPECT_TRUE(commit(files));
    return folder_ / name;
  }
  TempFolder folder_;
};

class Image {
 public:
  explicit Image(const std::filesystem::path& path)
      : surface_(cairo_image_surface_create_from_png(path.c_str())) {}
  Image(const Image&) = delete;
  Image& operator=(const Image&) = delete;
  ~Image() { cairo_surface_destroy(surface_); }
  int width() const { return cairo_image_surface_get_width(surface_); }
  int height() const { return cairo_image_surface_get_height(surface_); }
  // 0 black to 255 white.
  int brightness(int x, int y) const {
    const Color c = color(x, y);
    return static_cast<int>(255 * (c.red + c.green + c.blue) / 3);
  }
  Color color(int x, int y) const {
    const unsigned char* at = cairo_image_surface_get_data(surface_) +
                              y * cairo_image_surface_get_stride(surface_) + 4 * x;
    return {at[2] / 255.0, at[1] / 255.0, at[0] / 255.0};
  }
  double mean_brightness(int left, int top, int right, int bottom) const {
    double sum = 0;
    for (int y = top; y < bottom; ++y)
      for (int x = left; x < right; ++x) sum += brightness(x, y);
    return sum / (right - left) / (bottom - top);
  }

 private:
  cairo_surface_t* surface_;
};

bool alike(const Color& a, const Color& b) {
  return std::abs(a.red - b.red) + std::abs(a.green - b.green) + std::abs(a.blue - b.blue) < 0.02;
}

// 600 pixels for 4 units and a margin of 10: unit squares of 145 pixels.
TEST_F(DrawingTest, PutsTheBoundaryAndTheEdgesWhereTheyBelong) {
  const Image image(draw_to("m.png", square_mesh(4), {.long_side = 600}));
  EXPECT_EQ(image.width(), 600);
  EXPECT_EQ(image.height(), 600);
  EXPECT_LT(image.brightness(10, 200), 60);    // left side
  EXPECT_LT(image.brightness(589, 200), 60);   // right side
  EXPECT_LT(image.brightness(200, 10), 60);    // top
  EXPECT_LT(image.brightness(155, 230), 160);  // an inner edge
  EXPECT_EQ(image.brightness(110, 110), 255);  // inside a triangle: paper
  EXPECT_EQ(image.brightness(3, 300), 255);    // margin
  // Diagonals run from bottom left to top right.
  EXPECT_LT(image.brightness(82, 517), 200);
  EXPECT_EQ(image.brightness(110, 517), 255);
}

TEST_F(DrawingTest, PutsBoxesOverTheMeshAndCutsThemOffAtThePage) {
  const std::vector<double> boxes = {1.3, 1.3, 2.7, 9};
  const Image image(draw_to("m.png", square_mesh(4), {.long_side = 600, .boxes = boxes}));
  EXPECT_EQ(image.width(), 600);
  EXPECT_EQ(image.height(), 600);
  const auto is_box_ink = [&](int x, int y) {
    const Color c = image.color(x, y);
    return c.red > 0.6 && c.red - c.blue > 0.3;
  };
  EXPECT_TRUE(is_box_ink(198, 358));   // left side, at y = 1.6
  EXPECT_TRUE(is_box_ink(401, 358));   // right side
  EXPECT_TRUE(is_box_ink(280, 401));   // lower side
  EXPECT_TRUE(is_box_ink(198, 3));     // in the margin above the mesh
  EXPECT_FALSE(is_box_ink(100, 358));  // outside
  EXPECT_FALSE(is_box_ink(240, 340));  // inside
}

TEST_F(DrawingTest, ColorsByRegion) {
  const Image image(
      draw_to("m.png", square_mesh(4), {.color = DrawColor::kRegion, .long_side = 600}));
  EXPECT_TRUE(alike(image.color(110, 110), region_color(0)));
  EXPECT_TRUE(alike(image.color(500, 110), region_color(7)));
}

TEST_F(DrawingTest, ColorsBySmallestAngle) {
  const Image image(
      draw_to("m.png", square_mesh(4), {.color = DrawColor::kAngle, .long_side = 600}));
  EXPECT_TRUE(alike(image.color(110, 110), viridis(0.75)));  // 45 of 60 degrees
}

TEST_F(DrawingTest, BlendsTheEdgesOfADenseMeshToGreyUnderAClearBoundary) {
  const Image image(draw_to("m.png", square_mesh(400), {.long_side = 600}));
  const double inside = image.mean_brightness(100, 100, 500, 500);
  EXPECT_GT(inside, 100);
  EXPECT_LT(inside, 230);
  EXPECT_LT(image.brightness(10, 300), 110);
  EXPECT_EQ(image.brightness(3, 300), 255);
}

TEST_F(DrawingTest, ColorsADenseMesh) {
  const Image image(
      draw_to("m.png", square_mesh(400), {.color = DrawColor::kRegion, .long_side = 600}));
  const Color left = image.color(150, 300);
  const Color right = image.color(450, 300);
  EXPECT_LT(std::abs(left.red - left.blue), 0.1);  // grey, region 0
  EXPECT_GT(right.red - right.blue, 0.2);          // yellow, region 7
}

TEST_F(DrawingTest, TakesTheAspectRatioOfTheMesh) {
  Mesh mesh = square_mesh(4);
  for (std::size_t i = 1; i < mesh.coordinates.size(); i += 2) mesh.coordinates[i] /= 4;
  const Image image(draw_to("m.png", mesh, {.long_side = 600}));
  EXPECT_EQ(image.width(), 600);
  EXPECT_EQ(image.height(), 165);
}

TEST_F(DrawingTest, WritesSvgAndPdf) {
  EXPECT_NE(contents_of(draw_to("m.svg", square_mesh(4), {})).find("<svg"), std::string::npos);
  EXPECT_TRUE(contents_of(draw_to("m.PDF", square_mesh(4), {})).starts_with("%PDF"));
}

TEST_F(DrawingTest, EmbedsTheRasterOfADenseMesh) {
  const std::string svg = contents_of(draw_to("m.svg", square_mesh(400), {}));
  EXPECT_NE(svg.find("data:image/png"), std::string::npos);
  EXPECT_LT(svg.size(), 4'000'000u);
}

TEST_F(DrawingTest, IsTheSameFromOnePieceAndFromMany) {
  for (const std::uint32_t n : {4u, 150u, 600u}) {  // vectors, dense, and too many to be kept
    const Mesh mesh = square_mesh(n);
    for (const DrawColor color : {DrawColor::kNone, DrawColor::kRegion}) {
      const Options options{.color = color, .long_side = 600};
      const std::string whole = contents_of(draw_to("m.png", mesh, options));
      Options in_pieces = options;
      in_pieces.pieces = 7;
      EXPECT_TRUE(contents_of(draw_to("m.png", mesh, in_pieces)) == whole) << n;
    }
  }
}

TEST_F(DrawingTest, OfMoreTrianglesThanAreKeptLooksLikeOneOfFewer) {
  const auto drawn = [&](std::uint32_t n) {
    return Image(draw_to("m.png", square_mesh(n), {.color = DrawColor::kRegion, .long_side = 600}))
        .mean_brightness(100, 100, 500, 500);
  };
  static_assert(2 * 500 * 500 < Drawing::kMostVectors && Drawing::kMostVectors < 2 * 530 * 530);
  EXPECT_NEAR(drawn(530), drawn(500), 2);
}

TEST_F(DrawingTest, DrawsAnEmptyMeshAsBlankPaper) {
  const Image image(draw_to("m.png", Mesh{}, {.long_side = 600}));
  EXPECT_GT(image.width(), 0);
}

TEST(DrawFormat, GoesByExtension) {
  EXPECT_EQ(draw_format("a.PNG"), DrawFormat::kPng);
  EXPECT_EQ(draw_format("a.jpg"), std::nullopt);
}

}  // namespace
}  // namespace weft::client
