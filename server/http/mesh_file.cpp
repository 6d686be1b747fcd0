// SPDX-License-Identifier: Apache-2.0
#include "server/http/mesh_file.h"

#include <grpcpp/support/proto_buffer_reader.h>

#include <span>
#include <utility>

#include "files/formats/mesh_formats.h"
#include "wire/chunk_view.h"

namespace weft::server {
namespace {

// Bytes of each array of a spool, and of its pages, that may stay in memory.
constexpr std::size_t kSmallArray = std::size_t{64} << 10;
constexpr std::size_t kSmallPages = std::size_t{1} << 20;

tl::unexpected<Problem> no_room(const std::string& why) {
  return tl::unexpected(Problem{.status = 507, .reason = "STORE_FULL", .detail = why});
}

}  // namespace

Outcome<std::shared_ptr<files::MeshSpool>> make_spool(const std::filesystem::path& folder,
                                                      std::stop_token stop) {
  auto spool = files::MeshSpool::create(
      folder, {.stop = std::move(stop), .in_memory = kSmallArray, .small = kSmallPages});
  if (!spool) return no_room("the server has no room for the mesh while it arrives");
  return std::shared_ptr<files::MeshSpool>(std::move(*spool));
}

Outcome<std::optional<v1::Summary>> take_message(const grpc::ByteBuffer& message,
                                                 files::MeshSpool& spool) {
  grpc::ByteBuffer bytes = message;
  grpc::ProtoBufferReader reader(&bytes);
  v1::GenerateMeshResponse response;
  if (!response.ParseFromZeroCopyStream(&reader))
    return tl::unexpected(
        Problem{.status = 500, .reason = "INTERNAL", .detail = "a message cannot be parsed"});
  if (response.has_summary()) return std::move(*response.mutable_summary());
  if (!response.has_chunk()) return std::nullopt;
  const v1::Chunk& chunk = response.chunk();
  const auto taken = spool.append(wire::view_of(chunk));
  if (!taken) return no_room("the server has no room for the mesh while it arrives");
  return std::nullopt;
}

Outcome<MeshFile> write_mesh_file(files::MeshSpool& spool, const SentDomain& sent,
                                  const std::string& extension, const std::filesystem::path& folder,
                                  std::stop_token stop) {
  auto view = spool.view();
  if (!view) return no_room("the server has no room for the mesh");
  files::MeshView mesh = *view;
  mesh.input_point_markers = sent.domain.point_markers;
  mesh.names = &sent.domain.names;
  files::ScratchArray<double> lonlat;
  if (sent.projection != nullptr && sent.projection->to_metres())
    mesh.unit = files::CoordinateUnit::kMetres;
  if (sent.projection != nullptr && !sent.projection->to_metres()) {
    auto brought = sent.projection->to_lonlat(mesh);
    if (!brought)
      return tl::unexpected(
          Problem{.status = 500, .reason = "INTERNAL", .detail = brought.error().message});
    lonlat = std::move(*brought);
    mesh.coordinates = lonlat.values();
    mesh.unit = files::CoordinateUnit::kDegrees;
  }
  const files::DataPath path = folder / ("mesh" + extension);
  auto output = files::OutputFile::create(path, std::move(stop));
  if (!output) return no_room("the server has no room for the file");
  const std::size_t straight =
      files::write_mesh(*files::mesh_format(path), mesh, std::span(&*output, 1), sent.writing);
  if (!output->finish()) return no_room("the server has no room for the file");
  MeshFile file{.bytes = output->size()};
  if (straight > 0)
    file.warnings.push_back(std::to_string(straight) +
                            " sides on arcs are straight, because a triangle would turn over");
  for (const std::string& lost : files::not_carried(path, mesh))
    file.warnings.push_back(FileTexts(path.string(), path.filename().string())(lost));
  file.file = output->take();
  return file;
}

}  // namespace weft::server
