// SPDX-License-Identifier: Apache-2.0
// What the machine grants this process: processors, by affinity and cgroup quota, memory, by
// cgroup limit, and descriptors. Both versions of cgroups are read, and every level from the
// process's own group to the root, since the tightest counts. A container often shows its group as
// the root: levels whose files are absent are skipped.
#pragma once

#include <cstdint>
#include <filesystem>

namespace weft::server {

struct Machine {
  // Processors that this process may use at once, at least 1; a fraction counts as a whole one.
  std::uint32_t threads = 1;
  // Bytes that this process may use.
  std::uint64_t memory = 0;
  // Descriptors that this process may have, of files and connections.
  std::uint64_t descriptors = 1024;
};

// What the kernel reports about the process, under `root`: proc/self/cgroup, proc/meminfo and
// sys/fs/cgroup. `allowed` is the number of processors of the affinity mask.
Machine read_machine(const std::filesystem::path& root, std::uint32_t allowed);

// The machine that runs this process. Raises the number of descriptors to the hard limit first, as
// far as a process can use it.
Machine this_machine();

}  // namespace weft::server
