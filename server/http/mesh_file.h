// SPDX-License-Identifier: Apache-2.0
// The mesh of a request on its way from the chunks of a call to a file.
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files/base/atomic_file.h"
#include "files/formats/meshes/geojson_mesh.h"
#include "files/formats/names.h"
#include "files/message/mesh_spool.h"
#include "server/http/domain_file.h"
#include "server/http/workers.h"
#include "weft/v1/job_service.pb.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// The format that can be written while a mesh arrives.
inline constexpr std::string_view kStreamed = ".geojson";

struct MeshFile {
  files::FileDescriptor file;
  std::uint64_t bytes = 0;
  std::vector<std::string> warnings;
};

// Not thread-safe.
class ArrivingMesh {
 public:
  // Its arrays are nameless files in `folder`, so that it takes little memory. `stop` ends what
  // takes long. `streamed`: the names in a .geojson that is written while the mesh arrives; null:
  // none is.
  static Outcome<std::shared_ptr<ArrivingMesh>> make(const std::filesystem::path& folder,
                                                     const files::Names* streamed,
                                                     std::stop_token stop);

  bool streams() const { return file_.has_value(); }
  // What is there of the file that streams, by a descriptor of its own.
  MeshFile so_far() const { return {.file = file_->share(), .bytes = file_->size()}; }
  std::uint64_t triangles() const { return spool_->triangles(); }
  // Of its arrays, and of the file that streams.
  std::uint64_t bytes() const { return spool_->bytes() + (streams() ? file_->size() : 0); }

  // Takes in a GenerateMeshResponse; returns its summary, if it is that. The server's own chunks
  // need no check.
  Outcome<std::optional<v1::Summary>> take(const grpc::ByteBuffer& message, const SentDomain& sent);

  // Writes the mesh with the extension, or the rest of it if it streams; then the file stays here.
  // REQUIRES: one of written_formats().
  Outcome<MeshFile> write(const SentDomain& sent, const std::string& extension);

 private:
  ArrivingMesh(std::filesystem::path folder, std::stop_token stop)
      : folder_(std::move(folder)), stop_(std::move(stop)) {}

  const std::filesystem::path folder_;
  const std::stop_token stop_;
  std::unique_ptr<files::MeshSpool> spool_;
  std::optional<files::OutputFile> file_;  // that streams, and what writes it
  std::optional<files::GeojsonMeshWriter> writer_;
};

}  // namespace weft::server
