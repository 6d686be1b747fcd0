// SPDX-License-Identifier: Apache-2.0
#include "client/drawing/draw.h"

#include <cairo.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "client/drawing/coloring.h"
#include "client/drawing/colors.h"
#include "client/drawing/drawn_triangle.h"
#include "client/drawing/legend.h"
#include "tests/files/support/sample_mesh.h"
#include "tests/files/support/temp_folder.h"

namespace weft::client {
namespace {

class DrawingTest : public ::testing::Test {
 protected:
  struct Options {
    DrawColor color = DrawColor::kNone;
    std::uint32_t long_side = 1800;
    DrawOptions more = {.no_legend = true};
    std::vector<double> boxes = {};
    std::size_t pieces = 1;
    AreaBound bound = {};
  };
  std::filesystem::path draw_to(const std::string& name, const Mesh& mesh, const Options& options) {
    std::vector<OutputFile> files;
    files.push_back(std::move(OutputFile::create(folder_ / name, {}).value()));
    DrawOptions wanted = options.more;
    wanted.color = options.color;
    wanted.pixels = options.long_side;
    Drawing drawing(wanted, options.bound);
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
    drawing.name_regions(mesh.names.regions);
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

// The widest thing in a legend of the regions 0 and 7, in ems.
double width_of_regions(const std::string& name_of_7) {
  Coloring coloring(DrawColor::kRegion, DrawnUnit::kNone, {});
  for (const int region : {0, 7}) coloring.note_region(region);
  Legend legend(1);
  legend.add_colors(coloring, DrawnUnit::kNone, false, {{7, name_of_7}});
  return legend.least_width();
}

TEST(LegendTest, HasTheNamesOfRegionsUpTo32Characters) {
  EXPECT_GT(width_of_regions("the sea beyond"), width_of_regions("sea") + 3);
  std::string greek;
  for (int i = 0; i < 32; ++i) greek += "\u03c9";
  EXPECT_GT(width_of_regions(greek + "\u03c9"), width_of_regions(greek));
  EXPECT_EQ(width_of_regions(greek + "\u03c9"), width_of_regions(greek + greek));
}

TEST_F(DrawingTest, HasTheNamesOfRegionsInItsLegend) {
  Mesh mesh = square_mesh(4);
  const auto bytes = [&](const NameTable& names) {
    mesh.names.regions = names;
    return contents_of(draw_to("m.png", mesh, {.color = DrawColor::kRegion, .more = {}}));
  };
  EXPECT_NE(bytes({{7, "sea"}}), bytes({}));
  EXPECT_EQ(bytes({{7, "7"}}), bytes({}));
}

TEST_F(DrawingTest, ColorsBySmallestAngle) {
  const Image image(
      draw_to("m.png", square_mesh(4), {.color = DrawColor::kAngle, .long_side = 600}));
  EXPECT_TRUE(alike(image.color(110, 110), viridis(0.75)));  // 45 of 60 degrees
}

TEST_F(DrawingTest, ColorsByAreaOverItsBound) {
  // Areas are 0.5: half of the bound on the left, none on the right.
  const AreaBound loose = [](Point p) { return p.x < 2 ? 1 : 0; };
  const Image holds(draw_to("h.png", square_mesh(4),
                            {.color = DrawColor::kBound, .long_side = 600, .bound = loose}));
  EXPECT_TRUE(alike(holds.color(110, 110), viridis(0.5)));
  EXPECT_TRUE(alike(holds.color(500, 110), viridis(0)));
  // Half as much again as the bound on the left: the colours go to 2.
  const AreaBound tight = [](Point p) { return p.x < 2 ? 1.0 / 3 : 1; };
  for (const std::uint32_t n : {4u, 400u}) {
    const Mesh mesh = square_mesh(n);
    const double middle = n / 2;
    const Image fails(draw_to("f.png", mesh,
                              {.color = DrawColor::kBound, .long_side = 600, .bound = [&](Point p) {
                                 return tight({p.x < middle ? 0. : 3., 0});
                               }}));
    EXPECT_TRUE(alike(fails.color(110, 110), viridis(0.75))) << n;
    EXPECT_TRUE(alike(fails.color(500, 110), viridis(0.25))) << n;
  }
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
  static_assert(2 * 350 * 350 < Drawing::kMaxVectors && Drawing::kMaxVectors < 2 * 370 * 370);
  EXPECT_NEAR(drawn(370), drawn(350), 2);
}

// Pixels of 600 for 2 units and a margin of 10: 290 per unit.
TEST_F(DrawingTest, ShowsWhatIsInTheZoomAndCutsTheRestOff) {
  const Options options{.color = DrawColor::kRegion,
                        .long_side = 600,
                        .more = {.zoom = DrawnBox{1, 2, 2, 1}, .no_legend = true}};
  const Image image(draw_to("m.png", square_mesh(4), options));
  EXPECT_EQ(image.width(), 600);
  EXPECT_EQ(image.height(), 310);
  EXPECT_TRUE(alike(image.color(200, 100), region_color(0)));              // x = 1.66
  EXPECT_TRUE(alike(image.color(400, 100), region_color(7)));              // x = 2.34
  EXPECT_LT(image.brightness(300, 100), image.brightness(200, 100) - 30);  // the edge at x = 2
  EXPECT_TRUE(alike(image.color(200, 3), region_color(0)));  // what is beside it fills the margin
}

TEST_F(DrawingTest, CountsTheTrianglesInTheZoom) {
  Drawing drawing({.zoom = DrawnBox{1.4, 1.4, 0.2, 0.2}});
  drawing.add(square_mesh(4).view());
  EXPECT_EQ(drawing.triangles(), 2u);
}

TEST_F(DrawingTest, ZoomsIntoADenseMeshUntilItsTrianglesAreSeen) {
  const Options options{.color = DrawColor::kAuto,
                        .long_side = 600,
                        .more = {.zoom = DrawnBox{301, 302, 4, 4}, .no_legend = true}};
  const Image image(draw_to("m.png", square_mesh(600), options));
  EXPECT_LT(image.brightness(155, 230), 160);  // an edge, as of square_mesh(4)
  EXPECT_EQ(image.brightness(110, 110), 255);
}

// Beyond 8 million pixels coordinates of cairo overflow.
TEST_F(DrawingTest, ZoomsIntoOneTriangleAsFarAsItGoes) {
  for (const DrawColor color : {DrawColor::kNone, DrawColor::kRegion}) {
    for (const double side : {1e-9, 1e-12}) {
      const Options options{.color = color,
                            .long_side = 300,
                            .more = {.zoom = DrawnBox{0.25, 0.5, side, side}, .no_legend = true}};
      const Image image(draw_to("m.png", square_mesh(1), options));
      const Color inside = color == DrawColor::kNone ? kPaper : region_color(0);
      EXPECT_TRUE(alike(image.color(150, 150), inside)) << side;
      EXPECT_TRUE(alike(image.color(2, 290), inside)) << side;
    }
  }
}

// A strip of unit squares beside one of squares a tenth as wide.
Mesh two_sizes() {
  Mesh mesh = square_mesh(20);
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 2)
    if (double& x = mesh.coordinates[i]; x > 10) x = 10 + (x - 10) / 10;
  return mesh;
}

TEST_F(DrawingTest, ColorsBySizeFromTheSmallestToTheLargest) {
  const Image image(draw_to("m.png", two_sizes(), {.color = DrawColor::kSize, .long_side = 1220}));
  // 60 pixels a unit: the middle of a triangle of each.
  EXPECT_GT(image.color(100, 50).red, 0.85);
  EXPECT_GT(image.color(100, 50).green, 0.85);
  EXPECT_LT(image.color(640, 50).red, 0.3);
  EXPECT_LT(image.color(640, 50).green, 0.2);
}

TEST_F(DrawingTest, ShowsTheMeanSizeInAnEvenToneIfTrianglesAreSmallerThanPixels) {
  Mesh mesh = square_mesh(800);
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 2)
    if (double& x = mesh.coordinates[i]; x > 400) x = 400 + (x - 400) / 4;
  const Image image(draw_to("m.png", mesh, {.color = DrawColor::kAuto, .long_side = 520}));
  int low = 255;
  int high = 0;
  for (int y = 100; y < 400; ++y)
    for (int x = 30; x < 150; ++x) {
      low = std::min(low, image.brightness(x, y));
      high = std::max(high, image.brightness(x, y));
    }
  EXPECT_LE(high - low, 12);
  EXPECT_GT(low, 130);                         // large: bright
  EXPECT_LT(image.brightness(290, 250), 90);   // small: dark
  EXPECT_GT(image.color(290, 250).blue, 0.2);  // and no grey
}

TEST_F(DrawingTest, HasNoColorsByItselfIfTrianglesAreSeen) {
  const Image image(
      draw_to("m.png", square_mesh(4), {.color = DrawColor::kAuto, .long_side = 600}));
  EXPECT_EQ(image.brightness(110, 110), 255);
}

TEST_F(DrawingTest, MarksTheWorstTriangles) {
  Mesh mesh = square_mesh(10);
  mesh.coordinates[2 * (3 * 11 + 7)] += 0.6;  // vertex (7, 3)
  const Options options{.long_side = 620, .more = {.worst = 1, .no_legend = true}};
  const Image image(draw_to("m.png", mesh, options));
  std::size_t marked = 0;
  for (int y = 0; y < 620; ++y)
    for (int x = 0; x < 620; ++x) {
      const Color c = image.color(x, y);
      if (!(c.red > 0.8 && c.green < 0.25)) continue;
      ++marked;
      EXPECT_NEAR(x, 10 + 60 * 7.5, 90);
      EXPECT_NEAR(y, 10 + 60 * 7, 90);
    }
  EXPECT_GT(marked, 20u);
}

TEST_F(DrawingTest, ListsTheWorstTrianglesInTheirOrder) {
  Mesh mesh = square_mesh(10);
  mesh.coordinates[2 * (3 * 11 + 7)] += 0.6;
  Drawing drawing({.worst = 3});
  drawing.add(mesh.view());
  const auto worst = drawing.worst();
  ASSERT_EQ(worst.size(), 3u);
  EXPECT_LT(worst[0].angle_deg, 30);
  EXPECT_LE(worst[0].angle_deg, worst[1].angle_deg);
  EXPECT_LE(worst[1].angle_deg, worst[2].angle_deg);
  for (const WorstTriangle& one : worst)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t v = one.triangle.vertices[k];
      EXPECT_EQ(one.triangle.corners[k].x, mesh.coordinates[2 * v]);
      const std::uint32_t* corners = &mesh.triangles[3 * one.triangle.id];
      EXPECT_NE(std::find(corners, corners + 3, v), corners + 3);
    }
}

TEST_F(DrawingTest, NumbersVerticesAndTrianglesWhereTheyFit) {
  const auto drawn = [&](std::uint32_t n, bool labels) {
    return contents_of(draw_to("m.png", square_mesh(n),
                               {.long_side = 600, .more = {.labels = labels, .no_legend = true}}));
  };
  EXPECT_TRUE(drawn(4, true) != drawn(4, false));
  EXPECT_TRUE(drawn(110, true) == drawn(110, false));  // five pixels a side: no room
}

TEST_F(DrawingTest, PutsScaleAndLegendBelowTheMesh) {
  const auto drawn = [&](DrawColor color, bool no_legend) {
    return draw_to("m.png", square_mesh(4),
                   {.color = color, .long_side = 600, .more = {.no_legend = no_legend}});
  };
  const Image image(drawn(DrawColor::kAngle, false));
  EXPECT_GE(image.width(), 600);
  EXPECT_GT(image.height(), 615);
  EXPECT_LT(image.height(), 720);
  // The bar has the colours from the first to the last.
  bool first = false;
  bool last = false;
  bool scale = false;
  for (int y = 601; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      first |= alike(image.color(x, y), viridis(0));
      last |= alike(image.color(x, y), viridis(1));
      scale |= x < 60 && image.brightness(x, y) < 80;
    }
  EXPECT_TRUE(first && last && scale);
  EXPECT_EQ(Image(drawn(DrawColor::kAngle, true)).height(), 600);
}

TEST_F(DrawingTest, DrawsDegreesAsLongAsTheyAreOnTheGround) {
  Mesh mesh = square_mesh(4);  // to 61 to 59 degrees north: half as wide as high
  for (std::size_t i = 0; i < mesh.coordinates.size(); ++i)
    mesh.coordinates[i] = i % 2 == 0 ? mesh.coordinates[i] / 2 : 59 + mesh.coordinates[i] / 2;
  const DrawOptions degrees{.no_legend = true, .unit = DrawnUnit::kDegrees};
  const Image image(draw_to("m.png", mesh, {.long_side = 620, .more = degrees}));
  EXPECT_EQ(image.height(), 620);
  EXPECT_NEAR(image.width(), 320, 2);
}

TEST(DrawnTriangle, HasItsAreaAndAngleOnTheGround) {
  const DrawnTriangle half{.corners = {Point{10, 60}, {10.002, 60}, {10, 60.001}}};
  EXPECT_NEAR(smallest_angle_deg(half, DrawnUnit::kDegrees), 45, 0.01);
  EXPECT_NEAR(area(half, DrawnUnit::kDegrees), 111.195 * 111.195 / 2, 1);
  EXPECT_NEAR(smallest_angle_deg(half, DrawnUnit::kNone), 26.565, 0.001);
  EXPECT_NEAR(area(half, DrawnUnit::kNone), 1e-6, 1e-9);
  const DrawnTriangle flat{.corners = {Point{0, 0}, {1, 0}, {2, 0}}};
  EXPECT_EQ(smallest_angle_deg(flat, DrawnUnit::kNone), 0);
}

TEST_F(DrawingTest, OutlinesAMeshWithoutEdges) {
  Mesh mesh = square_mesh(4);
  mesh.edges.clear();
  mesh.edge_markers.clear();
  const Image image(draw_to("m.png", mesh, {.long_side = 600}));
  EXPECT_LT(image.brightness(10, 200), 60);
  EXPECT_LT(image.brightness(589, 200), 60);
  EXPECT_LT(image.brightness(200, 10), 60);
  EXPECT_LT(image.brightness(200, 589), 60);
}

TEST_F(DrawingTest, TakesTrianglesOfEitherOrientation) {
  const std::string turned = contents_of(draw_to("m.png", square_mesh(4), {}));
  Mesh mesh = square_mesh(4);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 6)
    std::swap(mesh.triangles[t + 1], mesh.triangles[t + 2]);
  EXPECT_TRUE(contents_of(draw_to("m.png", mesh, {})) == turned);
}

TEST_F(DrawingTest, RefusesCoordinatesThatCannotBeDrawn) {
  std::vector<OutputFile> files;
  files.push_back(std::move(OutputFile::create(folder_ / "m.png", {}).value()));
  Mesh mesh = square_mesh(1);
  mesh.coordinates[0] = -1e308;
  mesh.coordinates[2] = 1e308;
  Drawing drawing({});
  drawing.add(mesh.view());
  const auto drawn = drawing.draw(DrawFormat::kPng, {}, files[0]);
  ASSERT_FALSE(drawn);
  EXPECT_EQ(drawn.error().exit, ExitCode::kUnreadableInput);
  EXPECT_EQ(drawn.error().message, "the mesh has a coordinate of -1e+308, drawings go to 1e+100");
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
