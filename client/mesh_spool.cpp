// SPDX-License-Identifier: Apache-2.0
#include "client/mesh_spool.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

namespace weft::client {

template <class T>
SpooledArray<T>::~SpooledArray() {
  if (values_ != nullptr) ::munmap(const_cast<T*>(values_), size_ * sizeof(T));
  if (!name_.empty()) ::unlink(name_.c_str());
}

template <class T>
Result<void> SpooledArray<T>::open(const std::filesystem::path& folder) {
  auto file = open_nameless(folder, name_);
  if (!file) return tl::unexpected(file.error());
  file_ = std::move(*file);
  return {};
}

template <class T>
bool SpooledArray<T>::map() {
  if (size_ == 0) return true;
  void* at = ::mmap(nullptr, size_ * sizeof(T), PROT_READ, MAP_SHARED, file_.get(), 0);
  if (at == MAP_FAILED) return false;
  ::madvise(at, size_ * sizeof(T), MADV_SEQUENTIAL);
  values_ = static_cast<const T*>(at);
  return true;
}

template class SpooledArray<double>;
template class SpooledArray<std::uint32_t>;
template class SpooledArray<std::int32_t>;

Result<std::unique_ptr<MeshSpool>> MeshSpool::create(const std::filesystem::path& folder) {
  std::unique_ptr<MeshSpool> spool(new MeshSpool(folder));
  for (const auto& opened : {spool->coordinates_.open(folder), spool->triangles_.open(folder),
                             spool->regions_.open(folder), spool->edges_.open(folder),
                             spool->edge_markers_.open(folder), spool->input_points_.open(folder)})
    if (!opened) return tl::unexpected(opened.error());
  return spool;
}

tl::unexpected<Error> MeshSpool::failed() const {
  return fail(
      ExitCode::kUnwritableOutput,
      folder_.string() + ": the mesh cannot be kept while it arrives: " + std::strerror(errno));
}

Result<void> MeshSpool::append(const MeshView& piece) {
  const auto append = [](auto& array, auto values) {
    return array.append(values.data(), values.size());
  };
  if (append(coordinates_, piece.coordinates) && append(triangles_, piece.triangles) &&
      append(regions_, piece.regions) && append(edges_, piece.edges) &&
      append(edge_markers_, piece.edge_markers) && append(input_points_, piece.input_points))
    return {};
  return failed();
}

Result<MeshView> MeshSpool::view() {
  if (!(coordinates_.map() && triangles_.map() && regions_.map() && edges_.map() &&
        edge_markers_.map() && input_points_.map()))
    return failed();
  return MeshView{coordinates_.values(),
                  triangles_.values(),
                  regions_.values(),
                  edges_.values(),
                  edge_markers_.values(),
                  input_points_.values(),
                  {}};
}

}  // namespace weft::client
