// SPDX-License-Identifier: Apache-2.0
#include "files/message/mesh_spool.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>

namespace weft::files {

template <class T>
void SpooledArray<T>::Unmap::operator()(T* address) const {
  ::munmap(address, bytes);
}

template <class T>
void SpooledArray<T>::open(const std::filesystem::path& folder, std::size_t in_memory) {
  folder_ = folder;
  in_memory_ = in_memory;
  void* room = ::mmap(nullptr, in_memory, PROT_READ | PROT_WRITE,
                      MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (room != MAP_FAILED) memory_ = {static_cast<T*>(room), Unmap{in_memory}};
}

template <class T>
bool SpooledArray<T>::spill(std::size_t size) {
  auto file = open_unlinked(folder_);
  if (!file || !write_all(file->get(), memory_.get(), size * sizeof(T))) return false;
  file_ = std::move(*file);
  memory_.reset();
  values_ = nullptr;
  mapped_ = 0;
  return true;
}

template <class T>
bool SpooledArray<T>::append(std::span<const T> values) {
  const std::size_t before = std::exchange(size_, size_ + values.size());
  if (memory_ && size_ * sizeof(T) <= in_memory_) {
    std::copy(values.begin(), values.end(), memory_.get() + before);
    return true;
  }
  if (!file_.is_open() && !spill(before)) return false;
  return write_all(file_.get(), values.data(), values.size_bytes());
}

template <class T>
bool SpooledArray<T>::append_zeros(std::size_t count) {
  const std::size_t before = std::exchange(size_, size_ + count);
  if (memory_ && size_ * sizeof(T) <= in_memory_) return true;
  if (!file_.is_open() && !spill(before)) return false;
  return ::lseek(file_.get(), static_cast<off_t>(count * sizeof(T)), SEEK_CUR) >= 0;
}

template <class T>
bool SpooledArray<T>::map(PagedMemory& pages) {
  if (memory_) {
    values_ = memory_.get();
    mapped_ = size_;
  }
  if (size_ == mapped_) return true;
  // Zeros at the end may not have been written yet.
  if (::ftruncate(file_.get(), static_cast<off_t>(size_ * sizeof(T))) != 0) return false;
  if (size_ > room_) {
    const std::size_t room = mapped_ == 0 ? size_ : 2 * size_;
    try {
      if (values_ != nullptr) pages.free(values_);
      values_ = nullptr;
      mapped_ = room_ = 0;
      values_ = static_cast<const T*>(pages.map(file_.get(), room * sizeof(T)));
    } catch (const std::system_error& failure) {
      errno = failure.code().value();
      return false;
    }
    room_ = room;
  }
  mapped_ = size_;
  return true;
}

template class SpooledArray<double>;
template class SpooledArray<std::uint32_t>;
template class SpooledArray<std::int32_t>;

Result<std::unique_ptr<MeshSpool>> MeshSpool::create(const std::filesystem::path& folder,
                                                     MeshSpoolOptions options) {
  std::unique_ptr<MeshSpool> spool(new MeshSpool(folder, std::move(options)));
  const std::size_t in_memory = spool->options_.in_memory;
  if (::access(folder.c_str(), W_OK | X_OK) != 0) return spool->failed();
  const auto open = [&](auto&... arrays) { (arrays.open(folder, in_memory), ...); };
  open(spool->coordinates_, spool->triangles_, spool->regions_, spool->edges_, spool->edge_markers_,
       spool->edge_bulges_, spool->input_points_);
  return spool;
}

tl::unexpected<Error> MeshSpool::failed() const {
  return fail(
      ExitCode::kUnwritableOutput,
      folder_.string() + ": the mesh cannot be kept while it arrives: " + std::strerror(errno));
}

Result<void> MeshSpool::append(const MeshView& piece) {
  const auto append_or_zeros = [](auto& array, auto values, std::size_t count) {
    return values.empty() ? array.append_zeros(count) : array.append(values);
  };
  const auto append_rest = [&] {
    return triangles_.append(piece.triangles) &&
           append_or_zeros(regions_, piece.regions, piece.triangle_count()) &&
           edges_.append(piece.edges) &&
           append_or_zeros(edge_bulges_, piece.edge_bulges, piece.edge_count()) &&
           input_points_.append(piece.input_points);
  };
  triangle_count_ += piece.triangle_count();
  edge_count_ += piece.edge_count();
  has_arcs_ = has_arcs_ || !piece.edge_bulges.empty();
  if (!coordinates_.append(piece.coordinates) ||
      !append_or_zeros(edge_markers_, piece.edge_markers, piece.edge_count()) ||
      !(options_.vertices_only || append_rest()))
    return failed();
  return options_.on_piece ? show(piece) : Result<void>();
}

Result<void> MeshSpool::show(MeshView piece) {
  if (!coordinates_.map(pages_)) return failed();
  piece.coordinates = coordinates_.values();
  options_.on_piece(piece);
  try {
    pages_.release();
  } catch (const std::system_error& failure) {
    errno = failure.code().value();
    return failed();
  }
  return {};
}

std::uint64_t MeshSpool::bytes() const {
  const auto of = []<class T>(const SpooledArray<T>& array) { return array.size() * sizeof(T); };
  return of(coordinates_) + of(triangles_) + of(regions_) + of(edges_) + of(edge_markers_) +
         of(edge_bulges_) + of(input_points_);
}

Result<MeshView> MeshSpool::view() {
  if (!(coordinates_.map(pages_) && triangles_.map(pages_) && regions_.map(pages_) &&
        edges_.map(pages_) && edge_markers_.map(pages_) && edge_bulges_.map(pages_) &&
        input_points_.map(pages_)))
    return failed();
  return MeshView{.coordinates = coordinates_.values(),
                  .triangles = triangles_.values(),
                  .regions = regions_.values(),
                  .edges = edges_.values(),
                  .edge_markers = edge_markers_.values(),
                  .input_points = input_points_.values(),
                  .input_point_markers = {},
                  .order = 1,
                  .pages = &pages_,
                  .edge_bulges = has_arcs_ ? edge_bulges_.values() : std::span<const double>()};
}

}  // namespace weft::files
