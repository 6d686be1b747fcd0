// SPDX-License-Identifier: Apache-2.0
// A JobStore in one file, for one server: weft.db in a folder of its own. It needs only the disk,
// and is the default store.
//
// Calls that have returned survive kill -9. A job's acceptance, end and removal survive a power
// failure, too, because these commits wait for the disk. Those of chunks, claims and renewals do
// not wait, but `finish` waits for all that came before it. With and without waiting, on a
// virtual disk that is idle or busy:
//
//                          idle               busy
//   submission          0.33   0.11        1.4   0.14    ms
//   chunk of 1 MiB       2.6    2.6        5.1    3.6    ms
//
// Chunks are in the same file, in pages of 16 KiB: one of 1 MiB is read in 0.26 ms (4 GB/s on one
// thread, 6 GB/s on two). SQLite alone, by the size of a page:
//
//   page              4 KiB   8 KiB   16 KiB   32 KiB   64 KiB
//   read, GB/s          3.3     4.2      5.0      5.2      5.4
//   write, MB/s         234     261      339      434      443
//   submission, ms     0.05    0.05     0.11     0.24     0.56    without waiting for the disk
//
// Mapping the file would read at 9 GB/s, but a read error of the disk would then end the process.
//
// On a full disk jobs can still be cancelled and deleted, and garbage be collected: weft.reserve
// keeps 4 MiB for these, if the disk had them when the folder was opened.
//
// One connection writes, under a mutex; a few others read meanwhile, and do not wait for the
// writer. A second server on the same folder is refused. So when the folder is opened, no holder of
// a claim is left, and all leases end.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "server/store/job_store.h"

namespace weft::server {

class SqliteStore {
 public:
  struct Options {
    std::string folder;       // made if it is missing, for its owner only
    std::size_t readers = 4;  // at once; further ones wait
    std::function<WallTime()> clock = [] { return std::chrono::system_clock::now(); };
  };

  // kUnavailable if another server has the folder, kBroken if the file has a newer version, or was
  // emptied since a server had it.
  static StoreResult<std::unique_ptr<JobStore>> open(Options options);
};

}  // namespace weft::server
