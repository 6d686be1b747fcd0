// SPDX-License-Identifier: Apache-2.0
#include "engine/size/vanishing_size.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "engine/size/size_spec.h"
#include "tests/engine/domain/shapes.h"

namespace weft {
namespace {

// `d` is the distance to all segments.
std::optional<Point> found(const std::string& text, const Pslg& pslg) {
  constexpr double kResolved = 1e-21;
  const ExecutionContext context;
  SizeSpec spec(text);
  spec.fields.push_back({"d", DistanceSpec{}});
  const Result<Domain> domain = triangulate(pslg, context);
  const Result<Size> size = make_size(spec, pslg, *domain, context);
  EXPECT_TRUE(size) << size.error().message;
  return *find_vanishing(size->function(), *domain, kResolved, context);
}

Pslg strip(double length) {
  Pslg pslg;
  add_box(pslg, {0, 0}, {1, length});
  return pslg;
}

TEST(VanishingSize, IsOneThatFallsAsTheSquareOfTheDistanceOrFaster) {
  for (const char* size : {"0.004*d^2", "0.4*d^2", "d^3", "d > 0.1 ? 1 : 0.4*d^2"})
    EXPECT_TRUE(found(size, square())) << size;
  EXPECT_TRUE(found("(0.1*d)^2", square(1e6)));
}

TEST(VanishingSize, IsNoneThatFallsMoreSlowlyOrHasALeastValue) {
  for (const char* size : {"d", "d^1.2", "1e-9*d^1.9", "max(0.4*d^2, 1e-4)", "-d^2", "1e9*d^2"})
    EXPECT_FALSE(found(size, square())) << size;
  EXPECT_FALSE(found("1e-4*y", strip(1000))) << "below the square of the distances at hand";
}

TEST(VanishingSize, IsNoneThatIsZeroAtOnePointOfASegment) {
  EXPECT_FALSE(found("0.9*((x-0.5)^2 + y*y)", square()));
}

}  // namespace
}  // namespace weft
