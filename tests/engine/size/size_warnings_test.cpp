// SPDX-License-Identifier: Apache-2.0
#include "engine/size/size_warnings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/engine/domain/shapes.h"
#include "tests/engine/refine/sound.h"

namespace weft {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

constexpr double kArea = 0.4330127018922193;  // of an equilateral triangle with edges of 1

std::vector<std::string> messages(const std::vector<SizeWarning>& warnings) {
  std::vector<std::string> messages;
  for (const SizeWarning& warning : warnings) messages.push_back(warning.message);
  return messages;
}

std::vector<std::string> warned(const SizeSpec& size, double least_bound, double side = 4) {
  return messages(size_warnings(size, {0, 0, side, side}, least_bound));
}

SizeSpec edge(SizeSpec::Value value) {
  SizeSpec size;
  size.value = std::move(value);
  size.measure = Measure::kEdge;
  return size;
}

TEST(SizeWarnings, AreNoneForWhatIsMeant) {
  EXPECT_THAT(warned({}, 0), IsEmpty());
  EXPECT_THAT(warned(edge(1.0), kArea), IsEmpty());
  EXPECT_THAT(warned(edge(4.0), 16 * kArea), IsEmpty());
  EXPECT_THAT(warned(edge(Raster{{0, 0}, 1, 1, 1, 1, {1}}), kArea), IsEmpty());
}

TEST(SizeWarnings, NameASizeThatIsLargerThanTheDomain) {
  EXPECT_THAT(warned(edge(500.0), 250000 * kArea, 1),
              ElementsAre("the size bounds nothing: it asks for edges of 500 or more in a domain "
                          "that is 1 by 1; is it in another unit than the domain?"));
}

TEST(SizeWarnings, NameARasterThatIsCoarserThanItsSizes) {
  EXPECT_THAT(
      warned(edge(Raster{{0, 0}, 0.5, 2, 1, 1, {1}}), kArea),
      ElementsAre("the raster of sizes is coarser than what it asks for: its nodes are "
                  "2 apart, and the least edge is 1; details between the nodes are missed"));
  EXPECT_THAT(warned(edge(Raster{{0, 0}, 0.5, 0.5, 1, 1, {1}}), 1e-4 * kArea), IsEmpty())
      << "something else asks for short edges";
}

TEST(SizeWarnings, NameAGradationWithinWithoutGradation) {
  SizeSpec size = edge(1.0);
  size.gradation_within = true;
  EXPECT_THAT(warned(size, kArea), ElementsAre("gradation_within has no effect without gradation"));
  size.gradation = 0.1;
  EXPECT_THAT(warned(size, kArea), IsEmpty());
}

TEST(SizeWarnings, NameFieldsThatTheSizeDoesNot) {
  SizeSpec size = edge(std::string("min(coast, 3*w) + slope(depth)"));
  for (const char* const name : {"coast", "w", "depth", "co", "oast", "mi", "width"})
    size.fields.push_back({name, DistanceSpec{}});
  EXPECT_THAT(warned(size, kArea), ElementsAre("the size does not name the field 'co'",
                                               "the size does not name the field 'oast'",
                                               "the size does not name the field 'mi'",
                                               "the size does not name the field 'width'"));
}

// The least bound is that of the mesh, whatever the kind of the size.
TEST(SizeWarnings, JudgeTheMeshThatWasMade) {
  const auto of = [](SizeSpec size) {
    return messages(sound({.pslg = square(), .size = std::move(size)}).summary.size_warnings);
  };
  EXPECT_THAT(of(edge(std::string("50 + x"))), ElementsAre(StartsWith("the size bounds nothing")));
  EXPECT_THAT(of(edge(std::string("x < 0.5 ? 50 : 0.2"))), IsEmpty());
  MeshRequest region{.pslg = square(), .size = edge(50.0)};
  region.pslg.regions.push_back({.at = {0.5, 0.5}, .max_area = 0.1});
  EXPECT_THAT(sound(region).summary.size_warnings, IsEmpty());
}

}  // namespace
}  // namespace weft
