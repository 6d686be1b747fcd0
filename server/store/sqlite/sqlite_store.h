// SPDX-License-Identifier: Apache-2.0
// A JobStore in one file, for one server: weft.db in a folder of its own. It needs nothing but the
// disk, and is the store of whoever names no other.
//
// What was answered is there after kill -9. It is there after a power failure too where it was a
// job's acceptance, end or removal, for these commits wait for the disk; chunks, claims and
// renewals do not, but `finish` waits for all that came before it. With and without waiting, on a
// virtual disk that is idle or kept busy by others:
//
//                          idle               busy
//   submission          0.33   0.11        1.4   0.14    ms
//   chunk of 1 MiB       2.6    2.6        5.1    3.6    ms
//
// Chunks live in the same file, in pages of 16 KiB: one of 1 MiB is read in 0.26 ms (4 GB/s on one
// thread, 6 GB/s on two). SQLite itself, bare, by the size of a page:
//
//   page              4 KiB   8 KiB   16 KiB   32 KiB   64 KiB
//   read, GB/s          3.3     4.2      5.0      5.2      5.4
//   write, MB/s         234     261      339      434      443
//   submission, ms     0.05    0.05     0.11     0.24     0.56    without waiting for the disk
//
// Mapping the file would read at 9 GB/s, but a disk that fails to read would then end the process.
//
// One connection writes, under a mutex; a few others read meanwhile, and wait for no writer.
// A second server on the same folder is refused. So whoever held a claim when the folder is opened
// is gone: its lease ends then, however long it was.
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
    std::string folder;       // made where it is missing, for its owner alone
    std::size_t readers = 4;  // at once; further ones wait
    std::function<WallTime()> clock = [] { return std::chrono::system_clock::now(); };
  };

  // kUnavailable if another server has the folder, kBroken if the file is of a newer version.
  static StoreResult<std::unique_ptr<JobStore>> open(Options options);
};

}  // namespace weft::server
