// SPDX-License-Identifier: Apache-2.0
// That libnetcdf reads the files is for read_back.py to say.
#include "files/bytes/netcdf_header.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/files/support/temp_folder.h"

namespace weft::files {
namespace {

std::string header_of(std::size_t length) {
  const TempFolder folder;
  NetcdfHeader header;
  const std::size_t nodes = header.dimension("n", length);
  header.variable("x", NetcdfType::kDouble, {nodes});
  header.variable("y", NetcdfType::kDouble, {nodes});
  std::vector<OutputFile> files;
  files.push_back(std::move(OutputFile::create(folder / "h.nc", {}).value()));
  header.put(files[0]);
  EXPECT_TRUE(commit(files));
  return contents_of(folder / "h.nc");
}

std::uint64_t big_endian_at(const std::string& bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i)
    value = value << 8 | static_cast<unsigned char>(bytes.at(at + i));
  return value;
}

// The place of the last variable ends the header.
TEST(NetcdfHeader, SaysWhereTheValuesOfAVariableBegin) {
  const std::string header = header_of(3);
  EXPECT_EQ(header.substr(0, 4), "CDF\2");
  EXPECT_EQ(big_endian_at(header, header.size() - 8), header.size() + 3 * sizeof(double));
}

TEST(NetcdfHeader, HasLengthsOf64BitsIfAnArrayHas4GiB) {
  constexpr std::size_t kFits = (std::size_t{1} << 29) - 1;
  EXPECT_EQ(header_of(kFits).substr(0, 4), "CDF\2");
  const std::string header = header_of(kFits + 1);
  EXPECT_EQ(header.substr(0, 4), "CDF\5");
  EXPECT_EQ(big_endian_at(header, header.size() - 8), header.size() + (std::uint64_t{1} << 32));
}

// The format takes a dimension without length for one that may grow.
TEST(NetcdfHeader, LeavesOutWhatHasNoValues) {
  const std::string header = header_of(0);
  EXPECT_EQ(header, std::string("CDF\2") + std::string(28, '\0'));
}

}  // namespace
}  // namespace weft::files
