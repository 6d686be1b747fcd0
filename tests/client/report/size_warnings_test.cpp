// SPDX-License-Identifier: Apache-2.0
#include "client/report/size_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/client/support/sample_mesh.h"

namespace weft::client {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

v1::SizeField edge(double length) {
  v1::SizeField size;
  size.set_measure(v1::MEASURE_EDGE);
  size.set_constant(length);
  return size;
}

v1::SizeField raster(double step, const std::vector<double>& values) {
  v1::SizeField size;
  v1::Raster& raster = *size.mutable_raster();
  raster.set_dx(step);
  raster.set_dy(step / 2);
  raster.mutable_values()->Add(values.begin(), values.end());
  return size;
}

TEST(SizeWarnings, AreNoneForWhatIsMeant) {
  EXPECT_THAT(size_warnings(v1::SizeField(), square_domain(4)), IsEmpty());
  EXPECT_THAT(size_warnings(edge(1), square_domain(4)), IsEmpty());
  EXPECT_THAT(size_warnings(raster(1, {1, 2, 100}), square_domain(4)), IsEmpty());
}

TEST(SizeWarnings, NameASizeThatIsLargerThanTheDomain) {
  EXPECT_THAT(size_warnings(edge(500), square_domain(1)),
              ElementsAre("the size bounds nothing: it asks for edges of 500 or more in a domain "
                          "that is 1 by 1; is it in another unit than the domain?"));
  v1::SizeField area;
  area.set_constant(0.4);
  EXPECT_THAT(size_warnings(area, square_domain(1)), IsEmpty()) << "edges of 0.96";
  area.set_constant(0.5);
  EXPECT_THAT(size_warnings(area, square_domain(1)), ElementsAre(StartsWith("the size bounds")));
}

TEST(SizeWarnings, NameARasterThatIsCoarserThanItsSizes) {
  EXPECT_THAT(size_warnings(raster(0.1, {1, 1e-4}), square_domain(4)),
              ElementsAre(StartsWith("the raster of sizes is coarser than what it asks for: its "
                                     "nodes are 0.1 apart, and the least edge is 0.0151967")));
}

TEST(SizeWarnings, NameFieldsThatTheSizeDoesNot) {
  v1::SizeField size = edge(1);
  size.set_expression("min(coast, 3*w) + slope(depth)");
  for (const char* const name : {"coast", "w", "depth", "co", "oast", "mi", "width"})
    size.add_fields()->set_name(name);
  EXPECT_THAT(size_warnings(size, square_domain(4)),
              ElementsAre("the size does not name the field 'co'",
                          "the size does not name the field 'oast'",
                          "the size does not name the field 'mi'",
                          "the size does not name the field 'width'"));
}

}  // namespace
}  // namespace weft::client
