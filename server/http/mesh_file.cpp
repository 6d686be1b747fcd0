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

tl::unexpected<Problem> no_room_to_arrive() {
  return no_room("the server has no room for the mesh while it arrives");
}

tl::unexpected<Problem> no_room_for_file() {
  return no_room("the server has no room for the file");
}

Outcome<files::OutputFile> create_file(const std::filesystem::path& folder,
                                       const std::string& extension, std::stop_token stop) {
  auto file = files::OutputFile::create(folder / ("mesh" + extension), std::move(stop));
  if (!file) return no_room_for_file();
  return std::move(*file);
}

// The coordinates of the chunk's vertices in degrees.
Outcome<files::ScratchArray<double>> to_lonlat(const v1::Chunk& chunk,
                                               const files::DomainProjection& projection) {
  std::vector<std::uint32_t> points(chunk.input_points().begin(), chunk.input_points().end());
  for (std::size_t i = 0; i < points.size(); i += 2) points[i] -= chunk.first_vertex();
  files::MeshView piece = wire::view_of(chunk);
  piece.input_points = points;
  auto lonlat = projection.to_lonlat(piece);
  if (!lonlat)
    return tl::unexpected(
        Problem{.status = 500, .reason = "INTERNAL", .detail = lonlat.error().message});
  return std::move(*lonlat);
}

}  // namespace

Outcome<std::shared_ptr<ArrivingMesh>> ArrivingMesh::make(const std::filesystem::path& folder,
                                                          const files::Names* streamed,
                                                          std::stop_token stop) {
  std::shared_ptr<ArrivingMesh> mesh(new ArrivingMesh(folder, std::move(stop)));
  files::MeshSpoolOptions options{
      .stop = mesh->stop_, .in_memory = kSmallArray, .small = kSmallPages};
  if (streamed != nullptr) {
    auto file = create_file(folder, std::string(kStreamed), mesh->stop_);
    if (!file) return tl::unexpected(file.error());
    mesh->file_.emplace(std::move(*file));
    mesh->writer_.emplace(*mesh->file_);
    options.on_piece = [&writer = *mesh->writer_, names = *streamed](files::MeshView piece) {
      piece.names = &names;
      writer.put_triangles(piece);
    };
  }
  auto spool = files::MeshSpool::create(folder, std::move(options));
  if (!spool) return no_room_to_arrive();
  mesh->spool_ = std::move(*spool);
  return mesh;
}

Outcome<std::optional<v1::Summary>> ArrivingMesh::take(const grpc::ByteBuffer& message,
                                                       const SentDomain& sent) {
  grpc::ByteBuffer bytes = message;
  grpc::ProtoBufferReader reader(&bytes);
  v1::GenerateMeshResponse response;
  if (!response.ParseFromZeroCopyStream(&reader))
    return tl::unexpected(
        Problem{.status = 500, .reason = "INTERNAL", .detail = "a message cannot be parsed"});
  if (response.has_summary()) return std::move(*response.mutable_summary());
  if (!response.has_chunk()) return std::nullopt;
  const v1::Chunk& chunk = response.chunk();
  files::MeshView piece = wire::view_of(chunk);
  files::ScratchArray<double> lonlat;
  if (sent.projection != nullptr && !sent.projection->to_metres()) {
    auto brought = to_lonlat(chunk, *sent.projection);
    if (!brought) return tl::unexpected(brought.error());
    lonlat = std::move(*brought);
    piece.coordinates = lonlat.values();
  }
  if (!spool_->append(piece)) return no_room_to_arrive();
  if (streams() && !file_->finish()) return no_room_for_file();
  return std::nullopt;
}

Outcome<MeshFile> ArrivingMesh::write(const SentDomain& sent, const std::string& extension) {
  auto view = spool_->view();
  if (!view) return no_room("the server has no room for the mesh");
  files::MeshView mesh = *view;
  mesh.input_point_markers = sent.domain.point_markers;
  mesh.names = &sent.domain.names;
  if (sent.projection != nullptr)
    mesh.unit = sent.projection->to_metres() ? files::CoordinateUnit::kMetres
                                             : files::CoordinateUnit::kDegrees;
  if (streams()) {
    writer_->finish(mesh);
    if (!file_->finish()) return no_room_for_file();
    return so_far();
  }
  auto output = create_file(folder_, extension, stop_);
  if (!output) return tl::unexpected(output.error());
  const files::DataPath path = output->target();
  const std::size_t straight =
      files::write_mesh(*files::mesh_format(path), mesh, std::span(&*output, 1), sent.writing);
  if (!output->finish()) return no_room_for_file();
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
