// SPDX-License-Identifier: Apache-2.0
#include "files/formats/triangle/triangle_arcs.h"

#include <gtest/gtest.h>

#include "files/formats/triangle/triangle_poly.h"
#include "tests/files/support/temp_folder.h"

namespace weft::files {
namespace {

// Half a disk, whose segments are numbered from 7.
constexpr char kHalf[] =
    "2 2 0\n"
    "1  -1 0\n"
    "2  1 0\n"
    "2 1\n"
    "7  1 2 5\n"
    "8  2 1 6\n"
    "0\n"
    "# arc=8:1\n";

class TriangleArcs : public ::testing::Test {
 protected:
  Result<Domain> read(std::string_view text) {
    return read_triangle_poly(folder_.write("half.poly", text));
  }
  std::string refusal(std::string_view line) {
    const auto domain = read(std::string(kHalf) + std::string(line) + "\n");
    if (domain) return "it was read";
    EXPECT_EQ(domain.error().exit, ExitCode::kUnreadableInput);
    return domain.error().message.substr(folder_.path().string().size() + 1);
  }
  TempFolder folder_;
};

TEST_F(TriangleArcs, NameSegmentsByTheirNumbers) {
  const auto domain = read(kHalf);
  ASSERT_TRUE(domain) << domain.error().message;
  ASSERT_EQ(domain->arcs.size(), 1u);
  EXPECT_EQ(domain->arcs[0], (Domain::Arc{1, 1}));
}

TEST_F(TriangleArcs, ComeBackAsTheyWereWritten) {
  auto domain = read(kHalf);
  ASSERT_TRUE(domain);
  domain->arcs = {{0, -1e-9}, {1, 0.1 + 0.2}};
  auto file = OutputFile::create(folder_ / "copy.poly", {});
  ASSERT_TRUE(file) << file.error().message;
  write_triangle_poly(*domain, *file);
  std::vector<OutputFile> files;
  files.push_back(std::move(*file));
  ASSERT_TRUE(commit(files));
  const auto copy = read_triangle_poly(folder_ / "copy.poly");
  ASSERT_TRUE(copy) << copy.error().message;
  EXPECT_EQ(copy->arcs, domain->arcs);
}

TEST_F(TriangleArcs, RefuseWhatNamesNoSegmentOrNoBulge) {
  EXPECT_EQ(refusal("# arc=9:1"),
            "half.poly: the comment \"# arc=9:1\" names a segment that is not there");
  for (const char* line : {"# arc=7", "# arc=7:", "# arc=7:one", "# arc=7:nan", "# arc=7:1 2"})
    EXPECT_EQ(refusal(line), "half.poly: the comment \"" + std::string(line) +
                                 "\" is not the number of a segment, a colon, and the bulge of its "
                                 "arc");
  EXPECT_EQ(refusal("# arc=8:0.5"), "half.poly: the segment 8 has two comments \"# arc=\"");
  EXPECT_EQ(refusal("# an arc=9:1"), "it was read");
}

}  // namespace
}  // namespace weft::files
