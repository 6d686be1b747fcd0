// SPDX-License-Identifier: Apache-2.0
// The C interface gives the mesh that the library for C++ makes of the same request.
#include "weft/c.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/engine/domain/shapes.h"
#include "tests/support/collected_mesh.h"
#include "weft/weft.h"

namespace weft {
namespace {

struct Free {
  void operator()(weft_request* request) const { weft_request_free(request); }
  void operator()(weft_mesh* mesh) const { weft_mesh_free(mesh); }
  void operator()(weft_error* error) const { weft_error_free(error); }
};

double figure(const weft_mesh* mesh, const char* path) {
  double value = NAN;
  EXPECT_TRUE(weft_figure(mesh, path, &value)) << path;
  return value;
}

// A square with a hole and a region.
struct Given {
  std::vector<double> points{0, 0, 4, 0, 4, 4, 0, 4, 1, 1, 2, 1, 2, 2, 1, 2};
  std::vector<std::uint32_t> segments{0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4};
  std::vector<std::int32_t> markers;
  std::unique_ptr<weft_request, Free> request{weft_request_new()};
  MeshRequest same;

  explicit Given(const std::vector<std::uint32_t>& areas = {}, weft_bound bound = {0, 0.3},
                 std::vector<std::int32_t> of_segments = {1, 1, 2, 2, 3, 3, 3, 3})
      : markers(std::move(of_segments)) {
    weft_set_points(get(), points.data(), points.size() / 2);
    weft_set_segments(get(), segments.data(), markers.data(),
                      areas.empty() ? nullptr : areas.data(), markers.size());
    weft_add_region(get(), 3, 3, 7, bound);
    for (std::size_t i = 0; i < points.size(); i += 2)
      same.pslg.points.push_back({points[i], points[i + 1]});
    for (std::size_t i = 0; i < markers.size(); ++i)
      same.pslg.segments.push_back(
          {segments[2 * i], segments[2 * i + 1], markers[i], areas.empty() ? kNone : areas[i]});
    same.pslg.regions = {{.at = {3, 3}, .id = 7, .max_area = area_of_edge(bound.max_edge)}};
  }

  weft_request* get() { return request.get(); }
  void set(const char* field, const char* text) { weft_set(get(), field, text); }
  void add_hole() {
    const double hole[] = {1.5, 1.5};
    weft_set_holes(get(), hole, 1);
    same.pslg.holes = {{1.5, 1.5}};
  }
  std::unique_ptr<weft_mesh, Free> make(weft_error** error = nullptr) {
    return std::unique_ptr<weft_mesh, Free>(weft_make(get(), nullptr, nullptr, error));
  }

  // Makes both, has the checker judge the one, and compares the other.
  void expect_same() {
    CollectedMesh judged;
    weft::Run run;
    const auto summary = stream(same, judged, run);
    ASSERT_TRUE(summary) << summary.error().message;
    EXPECT_EQ(verdict(same, judged, *summary), "");
    weft_error* error = nullptr;
    const auto made = make(&error);
    ASSERT_TRUE(made) << weft_error_message(error);
    std::size_t size = 0;
    const auto* const told = static_cast<const char*>(weft_mesh_summary(made.get(), &size));
    const std::string digest(summary->digest.begin(), summary->digest.end());
    EXPECT_NE(std::string(told, size).find(digest), std::string::npos);
    weft_arrays arrays WEFT_ARRAYS;
    weft_mesh_arrays(made.get(), &arrays);
    ASSERT_EQ(arrays.vertex_count, judged.mesh.vertices.size());
    ASSERT_EQ(arrays.triangle_count, judged.mesh.triangles.size());
    for (std::size_t i = 0; i < arrays.vertex_count; ++i)
      ASSERT_EQ(arrays.vertices[2 * i + 1], judged.mesh.vertices[i].y);
    for (std::size_t i = 0; i < arrays.triangle_count; ++i) {
      ASSERT_EQ(arrays.triangles[3 * i + 2], judged.mesh.triangles[i][2]);
      ASSERT_EQ(arrays.regions == nullptr ? 0 : arrays.regions[i], judged.mesh.regions[i]);
    }
    ASSERT_EQ(arrays.edge_count, judged.mesh.edges.size());
    for (std::size_t i = 0; i < arrays.edge_count; ++i)
      ASSERT_EQ(static_cast<std::int32_t>(arrays.edges[4 * i + 3]), judged.mesh.edges[i].marker);
  }

  std::string reason_and_field() {
    weft_error* told = nullptr;
    EXPECT_EQ(make(&told), nullptr);
    const std::unique_ptr<weft_error, Free> error(told);
    return std::string(weft_error_reason(told)) + " " + weft_error_field(told);
  }
};

TEST(CInterface, TakesConstants) {
  Given given;
  given.add_hole();
  given.set("size.constant", "0.2");
  given.set("size.measure", "edge");
  given.set("quality.min_angle_deg", "28");
  given.set("quality.placement", "circumcentre");
  given.set("quality.optimise", "1");
  given.same.min_angle_deg = 28;
  given.same.placement = Placement::kCircumcentre;
  given.same.sweeps = 1;
  given.same.size = 0.2;
  given.same.size.measure = Measure::kEdge;
  given.expect_same();
}

TEST(CInterface, TakesRastersAndLengthsAtMarkers) {
  Given given;
  given.add_hole();
  const std::array<double, 4> values{0.01, 0.02, 0.03, 0.1};
  const weft_grid grid{0, 0, 4, 4, 2, 2};
  weft_set_size_raster(given.get(), &grid, values.data());
  weft_add_size_at(given.get(), 3, 0.05);
  given.set("size.gradation", "0.3");
  given.same.size = Raster{{0, 0}, 4, 4, 2, 2, {values.begin(), values.end()}};
  given.same.size.gradation = 0.3;
  given.same.size.at = {{3, 0.05}};
  given.expect_same();
}

TEST(CInterface, KeepsSegments) {
  for (const std::vector<std::int32_t>& markers : {std::vector<std::int32_t>{3}, {}}) {
    Given given;
    given.add_hole();
    given.set("size.constant", "0.01");
    weft_keep(given.get(), markers.data(), markers.size());
    given.same.size = 0.01;
    given.same.keep = markers;
    given.expect_same();
  }
}

TEST(CInterface, TakesLayers) {
  Given given;
  given.add_hole();
  given.set("size.constant", "0.01");
  const std::int32_t region = 5;
  weft_add_layers(given.get(), 3, 0.01, 1.5, 2, &region);
  given.same.size = 0.01;
  given.same.layers = {{3, 0.01, 1.5, 2, 5}};
  given.expect_same();
}

TEST(CInterface, TakesPeriodicSides) {
  Given given({}, {0, 0.3}, {1, 2, 4, 8, 3, 3, 3, 3});
  given.add_hole();
  weft_add_size_at(given.get(), 8, 0.05);
  weft_add_periodic(given.get(), 8, 2);
  weft_add_periodic(given.get(), 1, 4);
  given.same.size.at = {{8, 0.05}};
  given.same.periodic = {{8, 2}, {1, 4}};
  given.expect_same();
}

// The checker cannot judge sizes by the width: it is given and not named.
TEST(CInterface, TakesFieldsOfAllKinds) {
  Given given;
  given.add_hole();
  const std::array<std::int32_t, 1> markers{3};
  const std::array<float, 4> depths{1, 2, 3, 4};
  const std::array<double, 6> triangle{0, 0, 9, 0, 0, 9};
  const std::array<std::uint32_t, 3> corners{0, 1, 2};
  const std::array<double, 3> heights{1, 2, 3};
  const weft_grid grid{0, 0, 4, 4, 2, 2};
  weft_add_distance(given.get(), "wall", markers.data(), 1);
  weft_add_raster(given.get(), "depth", &grid, depths.data());
  weft_add_mesh(given.get(), "height", triangle.data(), heights.data(), 3, corners.data(), 1);
  weft_add_distance_to(given.get(), "line", triangle.data(), 3, corners.data(), 1);
  weft_add_width(given.get(), "across");
  weft_add_distance(given.get(), "sides", nullptr, 0);
  const std::string size = "0.01 + 0.02 * wall + 1e-3 * depth + 1e-3 * height + 1e-3 * line";
  given.set("size.expression", size.c_str());
  given.same.size = size;
  given.same.size.fields = {{"wall", DistanceSpec{{3}}},
                            {"depth", FieldRaster{{0, 0}, 4, 4, 2, 2, {1, 2, 3, 4}}},
                            {"height", FieldMesh{{{0, 0}, {9, 0}, {0, 9}}, {{0, 1, 2}}, {1, 2, 3}}},
                            {"line", DistanceSpec{{}, {{0, 0}, {9, 0}, {0, 9}}, {{0, 1}}}},
                            {"across", WidthSpec{}},
                            {"sides", DistanceSpec{}}};
  given.expect_same();
}

TEST(CInterface, Simplifies) {
  Given given;
  given.add_hole();
  given.set("simplify", "6");  // of the region's edges of 0.3
  given.same.simplify = 6;
  given.expect_same();
  const auto made = given.make();
  ASSERT_TRUE(made);
  EXPECT_EQ(figure(made.get(), "simplification.points"), 4);
  EXPECT_EQ(figure(made.get(), "simplification.islands"), 1);
  EXPECT_EQ(figure(made.get(), "simplification.area"), 1);
}

TEST(CInterface, TakesAreas) {
  Given given({0, 0, 0, 0, 1, 1, 1, 1});
  const std::int32_t region = 5;
  weft_add_area(given.get(), &region, 0, {0.05, 0}, 0);
  weft_add_area(given.get(), nullptr, 0, {0, 0}, 1);
  given.set("domain.fill", "union");
  given.same.pslg.areas = {{.region = 5, .max_area = 0.05}, {.is_hole = true}};
  given.same.pslg.fill = Fill::kUnion;
  given.expect_same();
}

TEST(CInterface, TakesArcs) {
  Given given;
  const std::uint32_t segments[] = {1, 5};
  const double bulges[] = {0.5, -0.25};
  weft_set_arcs(given.get(), segments, bulges, 2);
  given.same.pslg.arcs = {{1, 0.5}, {5, -0.25}};
  given.add_hole();
  given.expect_same();
}

TEST(CInterface, NamesWhatItCannotTake) {
  // The squares of the last two are 0 and infinite.
  for (const double edge : {-1.0, 1e-200, 1e200})
    EXPECT_EQ(Given({}, {0, edge}).reason_and_field(), "BAD_OPTION domain.regions[0].max_edge")
        << edge;
  EXPECT_EQ(Given({}, {-1, 1}).reason_and_field(), "BAD_OPTION domain.regions[0].max_area");
  Given raster;
  const weft_grid grid{};
  weft_set_size_raster(raster.get(), &grid, nullptr);
  EXPECT_EQ(raster.reason_and_field(), "BAD_OPTION size.raster.dx");
  Given given;
  const double beyond[] = {1, 2};
  weft_set_points(given.get(), beyond, 1);
  const std::uint32_t ends[] = {0, 9};
  weft_set_segments(given.get(), ends, nullptr, nullptr, 1);
  EXPECT_EQ(given.reason_and_field(), "BAD_ARRAY domain.segment_markers");
}

TEST(CInterface, NamesTheTextThatAnOptionCannotHave) {
  for (const auto& [field, text] : {std::pair{"quality.placement", "north"},
                                    {"allow_unrefined", "perhaps"},
                                    {"quality.min_edge", "1e"},
                                    {"threads", "-1"}}) {
    Given given;
    given.set(field, text);
    weft_error* error = nullptr;
    EXPECT_EQ(given.make(&error), nullptr);
    ASSERT_NE(error, nullptr);
    EXPECT_STREQ(weft_error_field(error), field);
    EXPECT_NE(std::strstr(weft_error_message(error), text), nullptr) << weft_error_message(error);
    weft_error_free(error);
  }
}

TEST(CInterface, TakesMessagesAndRefusesWhatIsNone) {
  // domain { points: 0 0 1 0 0 1, unpacked; segments: 0 1 1 2 2 0 }
  std::string domain;
  for (const double number : {0., 0., 1., 0., 0., 1.}) {
    domain += '\x09';
    domain.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  domain += std::string("\x12\x06\x00\x01\x01\x02\x02\x00", 8);
  const std::string message = '\x0a' + std::string(1, static_cast<char>(domain.size())) + domain;
  const auto make = [](const std::string& bytes) {
    weft_error* error = nullptr;
    weft_mesh_free(weft_make_message(bytes.data(), bytes.size(), nullptr, nullptr, &error));
    const std::string reason = error == nullptr ? "" : weft_error_reason(error);
    weft_error_free(error);
    return reason;
  };
  EXPECT_EQ(make(message), "");
  EXPECT_EQ(make(message + "\xf8\x7f\x01"), "") << "a field that it does not know";
  EXPECT_EQ(make(""), "BAD_OPTION");
  for (std::size_t size = 1; size < message.size(); ++size)
    EXPECT_EQ(make(message.substr(0, size)), "MALFORMED_REQUEST") << size;
  EXPECT_EQ(make(message + std::string("\x0a\x0a\x0a\x08\0\0\0\0\0\0\0\0", 12)), "BAD_ARRAY")
      << "a packed array goes on where an unpacked one ended";
}

// TBB's threads do not go over to a child, which would wait for them.
TEST(CInterface, ServesAChildOfForkToo) {
  Given given;
  given.add_hole();
  given.set("size.constant", "1e-5");
  given.set("threads", "2");
  const auto makes = [&] {
    const auto mesh = given.make();
    return mesh != nullptr && figure(mesh.get(), "threads") == 2;
  };
  EXPECT_TRUE(makes());
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(300);
    ::_exit(makes() ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(makes());
}

}  // namespace
}  // namespace weft
