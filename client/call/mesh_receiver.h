// SPDX-License-Identifier: Apache-2.0
// Takes the messages of a GenerateMesh or FetchMesh stream, one by one, and believes none: the
// order of messages, the numbering of chunks, the shape of their arrays, the range of every index,
// the digest of every chunk, and at the end the counts and the digest of the whole. What holds is
// appended to the spool.
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

#include "client/base/error.h"
#include "client/base/sha256.h"
#include "client/call/mesh_spool.h"
#include "weft/v1/job_service.pb.h"
#include "weft/v1/mesh_service.pb.h"

namespace weft::client {

// What was submitted: the range of the indices that come back.
struct DomainCounts {
  std::uint64_t points = 0;
  std::uint64_t segments = 0;
};

class MeshReceiver {
 public:
  // Where `domain` is not known, what refers to it is not checked.
  MeshReceiver(MeshSpool& spool, std::optional<DomainCounts> domain)
      : spool_(spool), domain_(domain) {}

  Result<void> receive(const v1::GenerateMeshResponse& message);
  Result<void> receive(const v1::FetchMeshResponse& message);
  // From here on the messages are those of another call, which asked for the chunks that are
  // missing: a first_chunk of `chunks()`.
  void resume() { resuming_ = true; }
  // REQUIRES: the stream ended with OK. An error when no summary came.
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
  bool resuming_ = false;  // another `accepted` is to come
  std::optional<v1::Summary> summary_;
  std::uint32_t chunks_ = 0;
  std::uint64_t bytes_ = 0;
  Sha256 hash_;
  Sha256 mesh_hash_;                  // over the digests of the chunks
  std::vector<std::int32_t> zeros_;   // stand-in for regions that are all 0
  std::vector<std::uint32_t> edges_;  // as hashed
};

}  // namespace weft::client
