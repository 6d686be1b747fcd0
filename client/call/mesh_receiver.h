// SPDX-License-Identifier: Apache-2.0
// Takes the messages of a GenerateMesh or FetchMesh stream, one by one, and checks all of them: the
// order of messages, the numbering of chunks, the shape of their arrays, the range of every index,
// the digest of every chunk, and at the end the counts and the digest of the whole. Valid chunks
// are appended to the spool.
//
// Errors: kDataLoss names the chunk and what is wrong with it; kUnwritableOutput comes from the
// spool.
//
//   MeshReceiver receiver(*spool, DomainCounts{.points = 4, .segments = 4});
//   while (reader->Read(&message))
//     if (auto ok = receiver.receive(message); !ok) return ok;
//   Result<void> complete = receiver.finish();
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/base/files.h"
#include "client/base/sha256.h"
#include "files/base/error.h"
#include "files/message/mesh_spool.h"
#include "weft/v1/job_service.pb.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

// The size of the submitted domain: the range of the indices that the mesh refers to.
struct DomainCounts {
  std::uint64_t points = 0;
  std::uint64_t segments = 0;
};

class MeshReceiver {
 public:
  // If `domain` is not known, references to it are not checked.
  MeshReceiver(MeshSpool& spool, std::optional<DomainCounts> domain)
      : spool_(spool), domain_(domain) {}

  Result<void> receive(const v1::GenerateMeshResponse& message);
  Result<void> receive(const v1::FetchMeshResponse& message);
  // Call before the messages of another call, which asked for the missing chunks with
  // first_chunk = `chunks()`.
  void resume() { resuming_ = true; }
  // Returns an error if no summary arrived. REQUIRES: the stream ended with OK.
  Result<void> finish() const;

  const std::optional<v1::Accepted>& accepted() const { return accepted_; }
  const std::optional<v1::Summary>& summary() const { return summary_; }
  std::uint32_t chunks() const { return chunks_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  template <class Message>
  Result<void> receive_either(const Message& message);
  Result<void> receive(const v1::Accepted& accepted);
  Result<void> receive(const v1::Chunk& chunk);
  Result<void> receive(const v1::Summary& summary);
  Result<void> check_shape(const v1::Chunk& chunk) const;
  Result<void> check_indices(const v1::Chunk& chunk) const;
  std::string digest_of(const v1::Chunk& chunk);

  MeshSpool& spool_;
  std::optional<DomainCounts> domain_;
  std::optional<v1::Accepted> accepted_;
  bool resuming_ = false;  // whether another `accepted` is expected
  std::optional<v1::Summary> summary_;
  std::uint32_t chunks_ = 0;
  std::uint64_t bytes_ = 0;
  Sha256 hash_;
  Sha256 mesh_hash_;                  // over the digests of the chunks
  std::vector<std::int32_t> zeros_;   // hashed instead of regions if all are 0
  std::vector<std::uint32_t> edges_;  // as hashed
};

}  // namespace weft::client
