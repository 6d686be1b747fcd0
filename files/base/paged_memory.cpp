// SPDX-License-Identifier: Apache-2.0
#include "files/base/paged_memory.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace weft::files {
namespace {

constexpr int kNoFile = -1;

[[noreturn]] void fail_with(int problem) {
  throw std::system_error(problem, std::generic_category());
}

}  // namespace

PagedMemory::~PagedMemory() {
  for (const Mapping& mapping : mappings_) ::munmap(mapping.address, mapping.bytes);
}

PagedMemory::Mapping& PagedMemory::add(std::size_t bytes, int file, int protection) {
  const int sharing = file == kNoFile ? MAP_PRIVATE | MAP_ANONYMOUS : MAP_SHARED;
  void* address = ::mmap(nullptr, bytes, protection, sharing, file, 0);
  if (address == MAP_FAILED) fail_with(errno);
  (file == kNoFile ? in_memory_ : in_files_) += bytes;
  return mappings_.emplace_back(Mapping{address, bytes, file});
}

void* PagedMemory::allocate(std::size_t bytes) {
  constexpr int kReadWrite = PROT_READ | PROT_WRITE;
  if (in_memory_ + bytes <= small_) return add(bytes, kNoFile, kReadWrite).address;
  auto file = open_unlinked(folder_);
  if (!file) fail_with(errno);
  // If the disk has no room for a page, writing to it would raise SIGBUS.
  if (const int problem = ::posix_fallocate(file->get(), 0, static_cast<off_t>(bytes)))
    fail_with(problem);
  Mapping& mapping = add(bytes, file->get(), kReadWrite);
  mapping.own = std::move(*file);
  return mapping.address;
}

const void* PagedMemory::map(int file, std::size_t bytes) {
  return add(bytes, file, PROT_READ).address;
}

void PagedMemory::free(const void* address) {
  const auto mapping =
      std::find_if(mappings_.begin(), mappings_.end(),
                   [address](const Mapping& each) { return each.address == address; });
  ::munmap(mapping->address, mapping->bytes);
  (mapping->file == kNoFile ? in_memory_ : in_files_) -= mapping->bytes;
  mappings_.erase(mapping);
}

void PagedMemory::step() {
  if (stop_.stop_requested()) fail_with(ECANCELED);
  release();
}

void PagedMemory::release() {
  if (in_files_ <= small_) return;
  for (const Mapping& mapping : mappings_) {
    if (mapping.file == kNoFile) continue;
    // Maps the same file at the same place again. Unlike MADV_DONTNEED, that frees the page tables,
    // which each later step would otherwise search from end to end.
    const int protection = mapping.own.is_open() ? PROT_READ | PROT_WRITE : PROT_READ;
    if (::mmap(mapping.address, mapping.bytes, protection, MAP_SHARED | MAP_FIXED, mapping.file,
               0) == MAP_FAILED)
      fail_with(errno);
  }
}

}  // namespace weft::files
