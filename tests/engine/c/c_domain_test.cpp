// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/files/support/temp_folder.h"
#include "weft/c.h"

namespace weft {
namespace {

struct FreeDomain {
  void operator()(weft_domain* domain) const { weft_domain_free(domain); }
  void operator()(weft_request* request) const { weft_request_free(request); }
  void operator()(weft_mesh* mesh) const { weft_mesh_free(mesh); }
  void operator()(weft_error* error) const { weft_error_free(error); }
};
template <class T>
using Owned = std::unique_ptr<T, FreeDomain>;

// A square with a hole and two regions.
constexpr const char* kPoly =
    "8 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 1 1\n6 2 1\n7 2 2\n8 1 2\n"
    "8 1\n1 1 2 1\n2 2 3 1\n3 3 4 2\n4 4 1 2\n5 5 6 3\n6 6 7 3\n7 7 8 3\n8 8 5 3\n"
    "1\n1 1.5 1.5\n1\n1 3 3 0.5 0.25\n";

class CDomain : public ::testing::Test {
 protected:
  Owned<weft_domain> read(const std::string& name, const std::string& text,
                          const weft_file_options* options = nullptr) {
    weft_error* error = nullptr;
    Owned<weft_domain> domain(weft_read_domain(folder_.write(name, text).c_str(), options, &error));
    EXPECT_EQ(domain == nullptr, error != nullptr);
    error_.reset(error);
    return domain;
  }
  // "BAD_OPTION path: what is wrong", without the folder.
  std::string refusal(const std::string& name, const std::string& text,
                      const weft_file_options* options = nullptr) {
    if (read(name, text, options)) return "it was read";
    std::string message = weft_error_message(error_.get());
    if (message.starts_with(folder_.path().string()))
      message.erase(0, folder_.path().string().size() + 1);
    return std::string(weft_error_reason(error_.get())) + " " + weft_error_field(error_.get()) +
           ": " + message;
  }

  files::TempFolder folder_;
  Owned<weft_error> error_;
};

// The vertices, edges and regions of its mesh; or what is wrong.
std::string mesh_of(weft_request* request) {
  weft_set(request, "size.constant", "0.1");
  weft_error* error = nullptr;
  const Owned<weft_mesh> mesh(weft_make(request, nullptr, nullptr, &error));
  const Owned<weft_error> owned(error);
  if (!mesh) return weft_error_message(error);
  weft_arrays arrays WEFT_ARRAYS;
  weft_mesh_arrays(mesh.get(), &arrays);
  const auto bytes = [](const auto* array, std::size_t count) {
    return std::string(reinterpret_cast<const char*>(array), sizeof *array * count);
  };
  return bytes(arrays.vertices, 2 * arrays.vertex_count) +
         bytes(arrays.edges, 4 * arrays.edge_count) + bytes(arrays.regions, arrays.triangle_count);
}

TEST_F(CDomain, OfAFileMakesTheMeshOfItsArrays) {
  const auto domain = read("a.poly", kPoly);
  ASSERT_TRUE(domain) << weft_error_message(error_.get());
  const Owned<weft_request> of_file(weft_request_new());
  weft_set_domain(of_file.get(), domain.get());

  const Owned<weft_request> of_arrays(weft_request_new());
  const std::vector<double> points{0, 0, 4, 0, 4, 4, 0, 4, 1, 1, 2, 1, 2, 2, 1, 2};
  const std::vector<std::uint32_t> ends{0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4};
  const std::vector<std::int32_t> markers{1, 1, 2, 2, 3, 3, 3, 3};
  const std::array<double, 2> hole{1.5, 1.5};
  weft_set_points(of_arrays.get(), points.data(), 8);
  weft_set_segments(of_arrays.get(), ends.data(), markers.data(), nullptr, 8);
  weft_set_holes(of_arrays.get(), hole.data(), 1);
  weft_add_region(of_arrays.get(), 3, 3, 1, {0.25, 0});
  EXPECT_GT(mesh_of(of_file.get()).size(), 1000u);
  EXPECT_TRUE(mesh_of(of_file.get()) == mesh_of(of_arrays.get()));
}

TEST_F(CDomain, SaysWhichNumbersIdsOfRegionsStandFor) {
  const auto domain = read("a.poly", kPoly);
  const std::int32_t* ids = nullptr;
  const double* values = nullptr;
  ASSERT_EQ(weft_domain_region_values(domain.get(), &ids, &values), 1u);
  EXPECT_EQ(ids[0], 1);
  EXPECT_EQ(values[0], 0.5);
}

TEST_F(CDomain, HasTheWarningsOfItsFile) {
  const auto domain = read(
      "a.geojson", R"({"type": "Polygon", "coordinates": [[[0, 0], [40, 0], [40, 40], [0, 40]]]})");
  const char* kind = "";
  const char* const sentence = weft_domain_warning(domain.get(), 0, &kind);
  ASSERT_NE(sentence, nullptr);
  EXPECT_NE(std::string(sentence).find("a.geojson: coordinates[0] is a ring that is not closed"),
            std::string::npos)
      << sentence;
  EXPECT_STREQ(kind, "open-ring");
  EXPECT_EQ(weft_domain_warning(domain.get(), 1, nullptr), nullptr);
  EXPECT_EQ(weft_domain_warning(read("a.poly", kPoly).get(), 0, &kind), nullptr);
}

TEST_F(CDomain, KnowsWhetherItsFileIsInDegrees) {
  const std::string square = R"("coordinates": [[[0, 0], [4, 0], [4, 4], [0, 0]]]})";
  int is_geographic = -1;
  EXPECT_FALSE(weft_domain_is_geographic(read("a.poly", kPoly).get(), &is_geographic));
  EXPECT_EQ(is_geographic, -1);
  const std::string crs = R"("crs": {"type": "name", "properties": {"name": "EPSG:4326"}}, )";
  const auto domain = read("a.geojson", R"({"type": "Polygon", )" + crs + square);
  EXPECT_TRUE(weft_domain_is_geographic(domain.get(), &is_geographic));
  EXPECT_EQ(is_geographic, 1);
}

TEST_F(CDomain, IsOfTheFormatThatIsAskedFor) {
  weft_file_options options WEFT_FILE_OPTIONS;
  EXPECT_EQ(refusal("a.txt", kPoly).find("BAD_OPTION options: a.txt: the extension '.txt' is not"),
            0u);
  options.format = ".poly";
  EXPECT_TRUE(read("a.txt", kPoly, &options));
  options.struct_size = sizeof(std::size_t);  // of a caller that knows no formats
  EXPECT_FALSE(read("a.txt", kPoly, &options));
}

TEST_F(CDomain, ThatCannotBeReadIsRefusedByFileLineAndReason) {
  EXPECT_EQ(refusal("a.poly", "1 2 0 0\n1 0 x\n"),
            "BAD_OPTION path: a.poly:2:5: expected the y coordinate, found 'x'");
  weft_file_options options WEFT_FILE_OPTIONS;
  options.layer = "parcels";
  EXPECT_EQ(refusal("a.poly", kPoly, &options).find("BAD_OPTION options: a.poly: --layer"), 0u);
  weft_error* error = nullptr;
  EXPECT_EQ(weft_read_domain((folder_ / "no.poly").c_str(), nullptr, &error), nullptr);
  ASSERT_NE(error, nullptr);
  EXPECT_STREQ(weft_error_field(error), "path");
  weft_error_free(error);
  EXPECT_EQ(weft_read_domain(nullptr, nullptr, nullptr), nullptr);
}

}  // namespace
}  // namespace weft
