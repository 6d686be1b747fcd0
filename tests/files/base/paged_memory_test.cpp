// SPDX-License-Identifier: Apache-2.0
#include "files/base/paged_memory.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdint>
#include <fstream>
#include <string>
#include <system_error>
#include <vector>

#include "files/formats/mesh_formats.h"
#include "tests/files/support/sample_mesh.h"
#include "tests/files/support/temp_folder.h"

namespace weft::files {
namespace {

// Of this process's mapped files, in bytes.
std::uint64_t resident_file_bytes() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "RssFile:") {
      std::uint64_t kilobytes = 0;
      status >> kilobytes;
      return 1024 * kilobytes;
    }
  return 0;
}

TEST(PagedMemory, LeavesTheProcessAndKeepsItsContents) {
  constexpr std::size_t kCount = std::size_t{8} << 20;  // 64 MB
  const TempFolder folder;
  PagedMemory pages(folder.path());
  ScratchArray<std::uint64_t> array(&pages, kCount);
  EXPECT_EQ(array[kCount - 1], 0u);
  const std::uint64_t before = resident_file_bytes();
  std::uint64_t most = 0;
  for (const std::size_t i : numbers(&pages, kCount)) {
    array[i] = i;
    if (i % PagedMemory::kStride == 0) most = std::max(most, resident_file_bytes());
  }
  EXPECT_LT(most, before + (8 << 20));
  for (const std::size_t i : numbers(&pages, kCount)) ASSERT_EQ(array[i], i);
}

TEST(PagedMemory, LeavesTheProcessWhereALoopJumps) {
  constexpr std::size_t kCount = std::size_t{16} << 20;
  const TempFolder folder;
  PagedMemory pages(folder.path());
  ScratchArray<std::uint64_t> array(&pages, kCount);
  const std::uint64_t before = resident_file_bytes();
  Jumps jumps(&pages);
  for (std::size_t i = 0; i < 20'000; ++i) {
    const std::size_t at = i * 7'654'321 % kCount;
    jumps.to(at);
    array[at] = i;
  }
  EXPECT_LT(resident_file_bytes(), before + (16 << 20));
}

TEST(PagedMemory, LeavesNothingInTheFolder) {
  const TempFolder folder;
  {
    PagedMemory pages(folder.path(), {}, 0);
    const ScratchArray<int> array(&pages, 1000);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

int problem_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::system_error& failure) {
    return failure.code().value();
  }
  return 0;
}

TEST(PagedMemory, TellsThatTheDiskIsFullBeforeItIsWrittenTo) {
  const TempFolder folder;
  PagedMemory pages(folder.path());
  EXPECT_NE(problem_of([&] { pages.allocate(std::size_t{1} << 50); }), 0);
}

TEST(PagedMemory, EndsALoopIfAStopIsAskedFor) {
  const TempFolder folder;
  std::stop_source stop;
  PagedMemory pages(folder.path(), stop.get_token());
  pages.step();
  stop.request_stop();
  EXPECT_EQ(problem_of([&] { pages.step(); }), ECANCELED);
}

// Every format, from arrays in memory and from a spool with all scratch in files: the same bytes.
class PagedFiles : public ::testing::TestWithParam<const char*> {};

std::string files_of(const MeshView& mesh, const std::string& name, int order) {
  const TempFolder folder;
  const MeshWriteOptions options{.order = order};
  std::vector<OutputFile> files;
  for (const auto& file : mesh_files(folder / name))
    files.push_back(std::move(OutputFile::create(file, {}).value()));
  write_mesh(*mesh_format(name), mesh, files, options);
  const auto done = commit(files);
  EXPECT_TRUE(done) << done.error().message;
  std::string bytes;
  for (const auto& file : mesh_files(folder / name)) bytes += contents_of(file);
  return bytes;
}

TEST_P(PagedFiles, AreThoseFromMemory) {
  const std::string name = GetParam();
  const Mesh mesh = square_mesh(200);  // 80,000 triangles: a few strides
  const TempFolder folder;
  PagedMemory pages(folder.path(), {}, 0);
  MeshView paged = mesh.view();
  paged.pages = &pages;
  for (const int order : {1, 2}) {
    if (order == 2 && !mesh_format(name)->second_order) continue;
    const std::string bytes = files_of(mesh.view(), name, order);
    EXPECT_GT(bytes.size(), 1'000'000u);
    EXPECT_TRUE(files_of(paged, name, order) == bytes);
  }
}

TEST_P(PagedFiles, SayThatTheyWereInterrupted) {
  const std::string name = GetParam();
  const Mesh mesh = square_mesh(200);
  const TempFolder folder;
  std::stop_source stop;
  stop.request_stop();
  PagedMemory pages(folder.path(), stop.get_token(), 0);
  MeshView paged = mesh.view();
  paged.pages = &pages;
  std::vector<OutputFile> files;
  for (const auto& file : mesh_files(folder / name))
    files.push_back(std::move(OutputFile::create(file, {}).value()));
  write_mesh(*mesh_format(name), paged, files);
  const auto done = commit(files);
  ASSERT_FALSE(done);
  EXPECT_NE(done.error().message.find("interrupted"), std::string::npos) << done.error().message;
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

INSTANTIATE_TEST_SUITE_P(All, PagedFiles,
                         ::testing::Values("m.vtu", "m.msh", "m.node", "m.npz", "m.edge", "m.neigh",
                                           "m.14", "m.su2", "m.mesh", "m.vol", "m.mfem", "m.inp",
                                           "m.geojson", "m.obj", "m.off", "m.ply", "m.stl"),
                         [](const auto& info) {
                           const std::string name = info.param;
                           return "To" + name.substr(2);
                         });

}  // namespace
}  // namespace weft::files
