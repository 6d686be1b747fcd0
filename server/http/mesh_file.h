// SPDX-License-Identifier: Apache-2.0
// The mesh of a request on its way from the chunks of a call to a file.
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "files/base/atomic_file.h"
#include "files/message/mesh_spool.h"
#include "server/http/domain_file.h"
#include "server/http/workers.h"
#include "weft/v1/job_service.pb.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::server {

// A spool for a mesh that takes little memory: its arrays are nameless files in `folder`.
Outcome<std::shared_ptr<files::MeshSpool>> make_spool(const std::filesystem::path& folder,
                                                      std::stop_token stop);

// Takes in a GenerateMeshResponse; returns its summary, if it is that. The server's own chunks need
// no check.
Outcome<std::optional<v1::Summary>> take_message(const grpc::ByteBuffer& message,
                                                 files::MeshSpool& spool);

struct MeshFile {
  files::FileDescriptor file;
  std::uint64_t bytes = 0;
  std::vector<std::string> warnings;
};

// Writes the mesh with the extension. REQUIRES: one of written_formats().
Outcome<MeshFile> write_mesh_file(files::MeshSpool& spool, const SentDomain& sent,
                                  const std::string& extension, const std::filesystem::path& folder,
                                  std::stop_token stop);

}  // namespace weft::server
