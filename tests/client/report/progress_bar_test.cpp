// SPDX-License-Identifier: Apache-2.0
#include "client/report/progress_bar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace weft::client {
namespace {

v1::Progress at(v1::Stage stage, std::uint64_t triangles, std::uint64_t expected,
                double fraction = 0) {
  v1::Progress progress;
  progress.set_stage(stage);
  progress.set_triangles(triangles);
  progress.set_expected_triangles(expected);
  progress.set_fraction(fraction);
  return progress;
}

std::string shown(ProgressStyle style) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* stream = ::open_memstream(&text, &size);
  {
    ProgressBar bar(stream, style);
    bar.update(at(v1::STAGE_QUEUED, 0, 0));
    bar.update(at(v1::STAGE_REFINE, 1000, 4000, 0.125));
    bar.update(at(v1::STAGE_REFINE, 2000, 4000, 0.25));
  }
  std::fclose(stream);
  std::string out = text;
  std::free(text);
  return out;
}

TEST(ProgressBar, PrintsOneLinePerStageWhereThereIsNoTerminal) {
  EXPECT_EQ(shown(ProgressStyle::kLines),
            "weft: waiting\nweft: refining, 13 % done, 1,000 triangles so far\n");
}

TEST(ProgressBar, RedrawsItselfOnATerminalAndGoesAway) {
  const std::string out = shown(ProgressStyle::kBar);
  EXPECT_NE(out.find("\r\033[Krefining [###...........................] 1,000 triangles so far\r"),
            std::string::npos);
  EXPECT_TRUE(out.ends_with("\r\033[K"));
}

TEST(ProgressBar, IsSilentWhenToldSo) {
  EXPECT_EQ(shown(ProgressStyle::kNone), "");
}

TEST(ProgressBar, DoesNotOverflowWhenTheEstimateWasLow) {
  EXPECT_EQ(progress_text(at(v1::STAGE_EMIT, 9, 3, 1.5), true),
            "receiving [##############################] 9 triangles so far");
}

// A third of the work is left when nearly all triangles are made.
TEST(ProgressBar, TellsOneShareOfTheWorkOnly) {
  const v1::Progress late = at(v1::STAGE_REFINE, 9'548'285, 9'704'887, 0.75);
  EXPECT_EQ(progress_text(late, false), "refining, 75 % done, 9,548,285 triangles so far");
  EXPECT_EQ(progress_text(at(v1::STAGE_REFINE, 0, 9'704'887), false),
            "refining, about 9,704,887 triangles expected");
}

TEST(ProgressBar, LivesWithAFractionThatIsNoNumber) {
  EXPECT_EQ(progress_text(at(v1::STAGE_REFINE, 1, 3, std::nan("")), true),
            "refining [..............................] 1 triangle so far");
  EXPECT_EQ(done_of(at(v1::STAGE_REFINE, 1, 3, -5)), 0);
}

}  // namespace
}  // namespace weft::client
