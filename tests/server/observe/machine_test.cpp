// SPDX-License-Identifier: Apache-2.0
#include "server/observe/machine.h"
#include "tests/files/support/temp_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace weft::server {
namespace {

namespace fs = std::filesystem;

// A folder with what the kernel would show.
class Kernel {
 public:
  Kernel() { file("proc/meminfo", "MemTotal:       1000 kB\nMemFree: 10 kB\n"); }
  Kernel& file(const std::string& path, const std::string& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
    return *this;
  }
  Machine read(std::uint32_t allowed) const { return read_machine(root_.path(), allowed); }

 private:
  files::TempFolder root_;
};

TEST(Machine, WithoutCgroupsGrantsTheAffinityMaskAndAllMemory) {
  const Machine machine = Kernel().read(8);
  EXPECT_EQ(machine.threads, 8u);
  EXPECT_EQ(machine.memory, 1000u * 1024);
}

TEST(Machine, Version2QuotaLimitsTheThreads) {
  Kernel kernel;
  kernel.file("proc/self/cgroup", "0::/\n").file("sys/fs/cgroup/cpu.max", "300000 100000\n");
  EXPECT_EQ(kernel.read(8).threads, 3u);
  EXPECT_EQ(kernel.read(2).threads, 2u) << "the mask is tighter";
}

TEST(Machine, AFractionOfAProcessorCountsAsAWholeOne) {
  Kernel kernel;
  kernel.file("proc/self/cgroup", "0::/\n").file("sys/fs/cgroup/cpu.max", "150000 100000\n");
  EXPECT_EQ(kernel.read(8).threads, 2u);
  kernel.file("sys/fs/cgroup/cpu.max", "10000 100000\n");
  EXPECT_EQ(kernel.read(8).threads, 1u);
}

TEST(Machine, Version2MaxMeansNoLimit) {
  Kernel kernel;
  kernel.file("proc/self/cgroup", "0::/\n")
      .file("sys/fs/cgroup/cpu.max", "max 100000\n")
      .file("sys/fs/cgroup/memory.max", "max\n");
  EXPECT_EQ(kernel.read(8).threads, 8u);
  EXPECT_EQ(kernel.read(8).memory, 1000u * 1024);
}

TEST(Machine, TheTightestLevelOfTheHierarchyCounts) {
  Kernel kernel;
  kernel.file("proc/self/cgroup", "0::/a/b\n")
      .file("sys/fs/cgroup/a/cpu.max", "200000 100000\n")
      .file("sys/fs/cgroup/a/memory.max", "4096\n")
      .file("sys/fs/cgroup/a/b/cpu.max", "500000 100000\n")
      .file("sys/fs/cgroup/a/b/memory.max", "8192\n");
  EXPECT_EQ(kernel.read(8).threads, 2u);
  EXPECT_EQ(kernel.read(8).memory, 4096u);
}

TEST(Machine, AContainerThatSeesItsGroupAsTheRootIsLimited) {
  Kernel kernel;
  kernel.file("proc/self/cgroup", "0::/docker/abc\n")
      .file("sys/fs/cgroup/cpu.max", "100000 100000\n");
  EXPECT_EQ(kernel.read(8).threads, 1u);
}

TEST(Machine, Version1QuotaLimitsTheThreads) {
  Kernel kernel;
  kernel.file("proc/self/cgroup", "5:memory:/box\n4:cpu,cpuacct:/box\n")
      .file("sys/fs/cgroup/cpu,cpuacct/box/cpu.cfs_quota_us", "400000\n")
      .file("sys/fs/cgroup/cpu,cpuacct/box/cpu.cfs_period_us", "100000\n")
      .file("sys/fs/cgroup/memory/box/memory.limit_in_bytes", "2048\n");
  EXPECT_EQ(kernel.read(8).threads, 4u);
  EXPECT_EQ(kernel.read(8).memory, 2048u);
}

TEST(Machine, Version1MinusOneMeansNoQuota) {
  Kernel kernel;
  kernel.file("proc/self/cgroup", "4:cpu:/\n")
      .file("sys/fs/cgroup/cpu/cpu.cfs_quota_us", "-1\n")
      .file("sys/fs/cgroup/cpu/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(kernel.read(8).threads, 8u);
}

TEST(Machine, GarbageIsNoLimit) {
  Kernel kernel;
  kernel.file("proc/self/cgroup", "nonsense\n0::/\n").file("sys/fs/cgroup/cpu.max", "\x01 0\n");
  EXPECT_EQ(kernel.read(8).threads, 8u);
}

TEST(Machine, ThisOneGrantsSomething) {
  EXPECT_GE(this_machine().threads, 1u);
  EXPECT_GT(this_machine().memory, 0u);
}

}  // namespace
}  // namespace weft::server
