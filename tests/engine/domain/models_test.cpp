// SPDX-License-Identifier: Apache-2.0
// The domains of the models in tests/models.
#include <gtest/gtest.h>

#include "engine/domain/domain.h"
#include "tests/engine/domain/laws.h"
#include "tests/support/poly.h"

namespace weft {
namespace {

// By Euler's formula a triangulation of v vertices has 2 v - h - 2 + 2 (holes) triangles where h
// vertices lie on the boundary.
void expect_model(const std::string& name, std::size_t vertices, std::size_t triangles) {
  const Pslg pslg = read_poly(model(name));
  const ExecutionContext context;
  const Result<Domain> domain = triangulate(pslg, context);
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_EQ(domain->vertices.size(), vertices);
  EXPECT_EQ(domain->triangles.size(), triangles);
  EXPECT_EQ(domain->subsegments.size(), pslg.segments.size());
  EXPECT_EQ(broken_law(pslg, *domain), std::nullopt);
  if (vertices < 1000) {
    EXPECT_EQ(broken_chain(pslg, *domain), std::nullopt);
    EXPECT_EQ(broken_origin(pslg, *domain), std::nullopt);
  }
}

TEST(Model, PipeKeepsAllLaws) {
  expect_model("pipe.poly", 672, 688);
}
TEST(Model, KeyKeepsAllLaws) {
  expect_model("key.poly", 122, 124);
}
TEST(Model, CylinderKeepsAllLaws) {
  expect_model("cylinder.poly", 132, 132);
}
TEST(Model, UsEastCoastKeepsAllLaws) {
  expect_model("us-east-coast.poly", 9370, 9580);
}

}  // namespace
}  // namespace weft
