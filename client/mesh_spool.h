// SPDX-License-Identifier: Apache-2.0
// Holds a mesh while it arrives, outside of memory: one nameless file per array, which vanishes
// with the process, mapped into memory once the mesh is complete.
//
// Errors (kUnwritableOutput): the folder is missing, not writable or full. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "client/atomic_file.h"
#include "client/error.h"
#include "client/formats/mesh.h"

namespace weft::client {

// An array of T on disk. Appended to, then mapped.
template <class T>
class SpooledArray {
 public:
  SpooledArray() = default;
  SpooledArray(SpooledArray&& other) = delete;
  ~SpooledArray();

  Result<void> open(const std::filesystem::path& folder);
  // False with errno set on failure.
  bool append(const T* values, std::size_t count) {
    size_ += count;
    return write_all(file_.get(), values, count * sizeof(T));
  }
  std::size_t size() const { return size_; }
  // False with errno set on failure. REQUIRES: nothing is appended any more.
  bool map();
  std::span<const T> values() const { return {values_, values_ != nullptr ? size_ : 0}; }

 private:
  FileDescriptor file_;
  std::filesystem::path name_;
  std::size_t size_ = 0;
  const T* values_ = nullptr;
};

extern template class SpooledArray<double>;
extern template class SpooledArray<std::uint32_t>;
extern template class SpooledArray<std::int32_t>;

class MeshSpool {
 public:
  static Result<std::unique_ptr<MeshSpool>> create(const std::filesystem::path& folder);

  // Appends a piece; the arrays are as MeshView has them, regions and markers without gaps.
  Result<void> append(const MeshView& piece);

  // The whole mesh, valid as long as the spool. REQUIRES: nothing is appended any more.
  Result<MeshView> view();

  std::uint64_t vertices() const { return coordinates_.size() / 2; }
  std::uint64_t triangles() const { return triangles_.size() / 3; }
  std::uint64_t edges() const { return edge_markers_.size(); }

 private:
  explicit MeshSpool(std::filesystem::path folder) : folder_(std::move(folder)) {}
  tl::unexpected<Error> failed() const;

  std::filesystem::path folder_;
  SpooledArray<double> coordinates_;
  SpooledArray<std::uint32_t> triangles_;
  SpooledArray<std::int32_t> regions_;
  SpooledArray<std::uint32_t> edges_;
  SpooledArray<std::int32_t> edge_markers_;
  SpooledArray<std::uint32_t> input_points_;
};

}  // namespace weft::client
