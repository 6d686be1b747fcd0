// SPDX-License-Identifier: Apache-2.0
#include "server/observe/machine.h"

#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace weft::server {
namespace {

namespace fs = std::filesystem;

// The first word of the file as a number; nullopt if there is no file or no number ("max").
std::optional<double> read_number(const fs::path& file) {
  std::ifstream in(file);
  double value = 0;
  if (in >> value) return value;
  return std::nullopt;
}

// Calls `visit` with each level of a group's path below `mount`, the mount itself included.
void for_each_level(const fs::path& mount, const std::string& group,
                    const std::function<void(const fs::path&)>& visit) {
  fs::path level = mount;
  visit(level);
  for (const fs::path& part : fs::path(group).relative_path()) visit(level /= part);
}

struct Grant {
  double processors = std::numeric_limits<double>::infinity();
  double bytes = std::numeric_limits<double>::infinity();

  void limit_processors(double n) {
    if (n > 0) processors = std::min(processors, n);
  }
  void limit_bytes(std::optional<double> n) {
    if (n && *n > 0) bytes = std::min(bytes, *n);
  }
};

void read_version_2(const fs::path& level, Grant& grant) {
  std::ifstream in(level / "cpu.max");
  double quota = 0;
  double period = 0;
  if (in >> quota >> period && period > 0) grant.limit_processors(quota / period);
  grant.limit_bytes(read_number(level / "memory.max"));
}

void read_version_1(const fs::path& level, Grant& grant) {
  const auto quota = read_number(level / "cpu.cfs_quota_us");  // -1: no quota
  const auto period = read_number(level / "cpu.cfs_period_us");
  if (quota && period && *period > 0) grant.limit_processors(*quota / *period);
  grant.limit_bytes(read_number(level / "memory.limit_in_bytes"));
}

// Lines of proc/self/cgroup are ID:CONTROLLERS:PATH; version 2 has no controllers.
Grant read_cgroups(const fs::path& root) {
  const fs::path mount = root / "sys/fs/cgroup";
  Grant grant;
  std::ifstream lines(root / "proc/self/cgroup");
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const std::string group = line.substr(second + 1);
    if (controllers.empty()) {
      for_each_level(mount, group, [&](const fs::path& level) { read_version_2(level, grant); });
      continue;
    }
    // Version 1 is mounted under the joined names, and usually linked under each single one.
    std::vector<std::string> names{controllers};
    std::istringstream list(controllers);
    for (std::string name; std::getline(list, name, ',');) names.push_back(name);
    for (const std::string& name : names)
      for_each_level(mount / name, group,
                     [&](const fs::path& level) { read_version_1(level, grant); });
  }
  return grant;
}

double read_total_memory(const fs::path& root) {
  std::ifstream in(root / "proc/meminfo");
  std::string key;
  double kibibytes = 0;
  if (in >> key >> kibibytes && key == "MemTotal:") return kibibytes * 1024;
  return 0;
}

std::uint32_t allowed_processors() {
  // The mask of a large machine may need more than the 1024 bits of a plain cpu_set_t.
  for (int bits = 1024; bits <= 1 << 20; bits *= 2) {
    std::vector<cpu_set_t> mask(static_cast<std::size_t>(bits) / (8 * sizeof(cpu_set_t)));
    const std::size_t bytes = mask.size() * sizeof(cpu_set_t);
    if (sched_getaffinity(0, bytes, mask.data()) == 0)
      return static_cast<std::uint32_t>(CPU_COUNT_S(bytes, mask.data()));
  }
  return std::max(1u, std::thread::hardware_concurrency());
}

// Returns how many there may be now.
std::uint64_t raise_descriptors() {
  constexpr rlim_t kUseful = 65'536;
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return Machine{}.descriptors;
  const rlim_t before = limit.rlim_cur;
  limit.rlim_cur = std::max(before, std::min(limit.rlim_max, kUseful));
  return ::setrlimit(RLIMIT_NOFILE, &limit) == 0 ? limit.rlim_cur : before;
}

}  // namespace

Machine read_machine(const fs::path& root, std::uint32_t allowed) {
  const Grant grant = read_cgroups(root);
  const double processors = std::min<double>(allowed, std::ceil(grant.processors));
  const double bytes = std::min(read_total_memory(root), grant.bytes);
  return {.threads = static_cast<std::uint32_t>(std::max(1.0, processors)),
          .memory = static_cast<std::uint64_t>(bytes)};
}

Machine this_machine() {
  Machine machine = read_machine("/", allowed_processors());
  machine.descriptors = raise_descriptors();
  return machine;
}

}  // namespace weft::server
