// SPDX-License-Identifier: Apache-2.0
// Meshes that GenerateMesh calls have finished, in memory: a request with the same mesh_key is
// answered with the same messages, without the engine. The least recently used mesh goes
// first when there is no more room. One that is being read stays: it would take its memory until
// its last reader is done, whether the cache knows of it or not.
//
//   MeshRecording recording(cache.largest());
//   recording.add(message);                                   // each chunk, as it is sent
//   cache.keep(key, std::move(recording).finish(summary));    // unless it grew too large
//   if (auto mesh = cache.find(key)) ...
//
// Messages share their bytes with those that are being sent: nothing is copied.
// Thread-safety: every function of MeshCache may be called from any thread.
#pragma once

#include <grpcpp/support/byte_buffer.h>

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "weft/mesh.h"

namespace weft::server {

struct FinishedMesh {
  Summary summary;
  std::vector<grpc::ByteBuffer> chunks;  // by index; each is a GenerateMeshResponse
  std::uint64_t bytes = 0;               // of memory
};

// A mesh on its way into the cache.
class MeshRecording {
 public:
  // Gives up on a mesh of more bytes.
  explicit MeshRecording(std::uint64_t largest) : largest_(largest) {}

  void add(const grpc::ByteBuffer& message);
  // Null where it was given up.
  std::shared_ptr<const FinishedMesh> finish(const Summary& summary) &&;

 private:
  const std::uint64_t largest_;
  std::shared_ptr<FinishedMesh> mesh_ = std::make_shared<FinishedMesh>();
};

class MeshCache {
 public:
  // Holds so many bytes; 0: no cache.
  explicit MeshCache(std::uint64_t capacity) : capacity_(capacity) {}

  // Bytes of a mesh, at most: one mesh must not drive out all others.
  std::uint64_t largest() const { return capacity_ / 4; }
  // Null if there is none.
  std::shared_ptr<const FinishedMesh> find(const std::string& key);
  // Null is not kept, nor a mesh for which there is no room beside those that are being read.
  void keep(const std::string& key, std::shared_ptr<const FinishedMesh> mesh);
  std::uint64_t bytes() const;

 private:
  using Entry = std::pair<std::string, std::shared_ptr<const FinishedMesh>>;

  const std::uint64_t capacity_;
  mutable std::mutex mutex_;  // guards all below
  std::list<Entry> entries_;  // the one asked for last comes first
  std::unordered_map<std::string, std::list<Entry>::iterator> by_key_;
  std::uint64_t bytes_ = 0;
};

}  // namespace weft::server
