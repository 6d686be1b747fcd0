// SPDX-License-Identifier: Apache-2.0
#include "files/base/did_you_mean.h"

#include <gtest/gtest.h>

namespace weft::files {
namespace {

TEST(DidYouMean, NamesTheNearestWord) {
  EXPECT_EQ(did_you_mean("siez", {"snap", "size", "side"}), "did you mean `size`?");
  EXPECT_EQ(did_you_mean("min-agle", {"min-edge", "min-angle"}), "did you mean `min-angle`?");
}

TEST(DidYouMean, NamesTheFirstOfEquals) {
  EXPECT_EQ(did_you_mean("abcdx", {"abcda", "abcdb"}), "did you mean `abcda`?");
}

TEST(DidYouMean, IsSilentIfNothingIsNear) {
  EXPECT_EQ(did_you_mean("wondrous", {"size", "snap"}), "");
  EXPECT_EQ(did_you_mean("xy", {"xz"}), "");  // half of its letters
  EXPECT_EQ(did_you_mean(std::string(65, 'a'), {std::string(64, 'a')}), "");
  EXPECT_EQ(did_you_mean("", {"a"}), "");
}

}  // namespace
}  // namespace weft::files
