// SPDX-License-Identifier: Apache-2.0
// Holds a mesh while it arrives, on disk unless it is small: one nameless file per array that is
// not, which vanishes with the process, mapped into memory once the mesh is complete. (Meshes of up
// to a million triangles need no disk. Processor time is about the same; but ext4 takes long to
// make files where many were deleted in the last seconds.) `on_piece` gets the pieces as they
// arrive, with all vertices before them; for a drawing, only the vertices need be held.
//
// Errors (kUnwritableOutput): the folder is missing, not writable or full. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <stop_token>
#include <utility>

#include "files/base/atomic_file.h"
#include "files/base/error.h"
#include "files/base/paged_memory.h"
#include "files/formats/mesh.h"

namespace weft::files {

// An array of T, on disk if it is larger than `in_memory` bytes. Appended to, and mapped.
template <class T>
class SpooledArray {
 public:
  void open(const std::filesystem::path& folder, std::size_t in_memory);
  // Both return false with errno set on failure. Zeros take no room: they are untouched pages or a
  // hole in the file.
  bool append(std::span<const T> values);
  bool append_zeros(std::size_t count);
  std::size_t size() const { return size_; }
  // Maps what was appended so far; values appended later are not mapped until this is called
  // again. Returns false with errno set on failure. REQUIRES: the same `pages` every time, and the
  // array outlives them.
  bool map(PagedMemory& pages);
  std::span<const T> values() const { return {values_, mapped_}; }

 private:
  struct Unmap {
    std::size_t bytes = 0;
    void operator()(T* address) const;
  };
  // Moves the first `size` values to a file.
  bool spill(std::size_t size);

  std::filesystem::path folder_;
  FileDescriptor file_;  // once it is needed
  std::size_t in_memory_ = 0;
  std::unique_ptr<T, Unmap> memory_;  // room for in_memory_ bytes; null: all is in the file
  std::size_t size_ = 0;
  const T* values_ = nullptr;
  std::size_t mapped_ = 0;  // values
  std::size_t room_ = 0;    // values that the mapping can come to hold
};

extern template class SpooledArray<double>;
extern template class SpooledArray<std::uint32_t>;
extern template class SpooledArray<std::int32_t>;

struct MeshSpoolOptions {
  // Nothing else is held but the markers of edges: of the view, these alone are of use.
  bool vertices_only = false;
  // Called after every piece, with its triangles, regions and edges and the coordinates of all
  // vertices so far; may be empty. The spans are valid during the call.
  std::function<void(const MeshView&)> on_piece{};
  std::stop_token stop{};  // ends loops over the view, see paged_memory.h
  // Bytes of each array that stay in memory, and those of PagedMemory.
  std::size_t in_memory = std::size_t{16} << 20;
  std::size_t small = PagedMemory::kSmall;
};

class MeshSpool {
 public:
  static Result<std::unique_ptr<MeshSpool>> create(const std::filesystem::path& folder,
                                                   MeshSpoolOptions options = {});

  // Appends a piece; its arrays are as MeshView has them, regions and markers empty if all are 0,
  // bulges one per edge or empty.
  Result<void> append(const MeshView& piece);

  // Returns the whole mesh, valid as long as the spool. REQUIRES: nothing is appended any more.
  Result<MeshView> view();

  std::uint64_t vertices() const { return coordinates_.size() / 2; }
  std::uint64_t triangles() const { return triangle_count_; }
  std::uint64_t edges() const { return edge_count_; }
  // Of all arrays.
  std::uint64_t bytes() const;

 private:
  MeshSpool(std::filesystem::path folder, MeshSpoolOptions options)
      : folder_(std::move(folder)),
        options_(std::move(options)),
        pages_(folder_, options_.stop, options_.small) {}
  tl::unexpected<Error> failed() const;
  Result<void> show(MeshView piece);

  std::filesystem::path folder_;
  MeshSpoolOptions options_;
  std::uint64_t triangle_count_ = 0;
  std::uint64_t edge_count_ = 0;
  bool has_arcs_ = false;
  SpooledArray<double> coordinates_;
  SpooledArray<std::uint32_t> triangles_;
  SpooledArray<std::int32_t> regions_;
  SpooledArray<std::uint32_t> edges_;
  SpooledArray<std::int32_t> edge_markers_;
  SpooledArray<double> edge_bulges_;
  SpooledArray<std::uint32_t> input_points_;
  PagedMemory pages_;
};

}  // namespace weft::files
