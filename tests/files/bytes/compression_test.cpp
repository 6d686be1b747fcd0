// SPDX-License-Identifier: Apache-2.0
#include "files/bytes/compression.h"

#include <gtest/gtest.h>

namespace weft::files {
namespace {

std::string bytes(std::string_view base64) {
  return from_base64(base64).value();
}

const std::string kText = "the rain in spain in spain in spain";

TEST(Compression, UnpacksWhatOthersPacked) {
  EXPECT_EQ(unpacked(Packing::kZlib, bytes("eJwryUhVKErMzFMAouICrAwA4dcMog=="), kText.size()),
            kText);
  EXPECT_EQ(unpacked(Packing::kDeflate, bytes("K8lIVShKzMxTAKLiAqwMAA=="), kText.size()), kText);
  EXPECT_EQ(unpacked(Packing::kLz4, bytes("7HRoZSByYWluIGluIHNwCQBQc3BhaW4="), kText.size()),
            kText);
}

// An .xz needs a library that every Debian has.
TEST(Compression, UnpacksXz) {
  const std::string packed = bytes(
      "/Td6WFoAAATm1rRGAgAhARYAAAB0L+Wj4AAiABRdADoaCM520HVCjZdj4hwTRjb14AAAAH+s4NXgsPsfAAEwI6ryp10f"
      "tvN9AQAAAAAEWVo=");
  const auto whole = unpacked(Packing::kLzma, packed, kText.size());
  ASSERT_TRUE(whole) << whole.error();
  EXPECT_EQ(*whole, kText);
}

TEST(Compression, RefusesWhatIsDamaged) {
  for (const Packing packing : {Packing::kZlib, Packing::kDeflate, Packing::kLz4, Packing::kLzma}) {
    EXPECT_FALSE(unpacked(packing, "what is this", 40)) << static_cast<int>(packing);
    EXPECT_FALSE(unpacked(packing, "", 1)) << static_cast<int>(packing);
    EXPECT_EQ(unpacked(packing, "1234", std::uint64_t{1} << 40).error(), "claims an absurd size");
  }
  const std::string block = bytes("7HRoZSByYWluIGluIHNwCQBQc3BhaW4=");
  for (std::size_t size = 0; size < block.size(); ++size)
    EXPECT_FALSE(unpacked(Packing::kLz4, block.substr(0, size), kText.size())) << size;
  EXPECT_FALSE(unpacked(Packing::kLz4, block, kText.size() - 1));
}

TEST(Compression, ReadsGroupsOfBase64OneAfterTheOther) {
  EXPECT_EQ(from_base64("YQ==\n YmM=ZGVm"), "abcdef");
  EXPECT_EQ(from_base64(""), "");
  for (const char* wrong : {"YQ=", "Y", "Y===", "YQ=a", "Y-Q=", "=YQ="})
    EXPECT_FALSE(from_base64(wrong)) << wrong;
}

}  // namespace
}  // namespace weft::files
