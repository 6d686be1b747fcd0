// SPDX-License-Identifier: Apache-2.0
#include "server/mesh/mesh_cache.h"

#include <iterator>

namespace weft::server {

void MeshRecording::add(const grpc::ByteBuffer& message) {
  if (!mesh_) return;
  mesh_->bytes += message.Length() + sizeof(grpc::ByteBuffer);
  if (mesh_->bytes > largest_) {
    mesh_.reset();
  } else {
    mesh_->chunks.push_back(message);
  }
}

std::shared_ptr<const FinishedMesh> MeshRecording::finish(const Summary& summary) && {
  if (!mesh_) return nullptr;
  mesh_->summary = summary;
  mesh_->bytes += sizeof(FinishedMesh) + summary.leaves.size() * sizeof(summary.leaves[0]) +
                  summary.sampled_bounds.size() * sizeof(summary.sampled_bounds[0]);
  return mesh_->bytes <= largest_ ? std::move(mesh_) : nullptr;
}

std::shared_ptr<const FinishedMesh> MeshCache::find(const std::string& key) {
  const std::lock_guard lock(mutex_);
  const auto found = by_key_.find(key);
  if (found == by_key_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found->second);
  return found->second->second;
}

void MeshCache::keep(const std::string& key, std::shared_ptr<const FinishedMesh> mesh) {
  if (!mesh || mesh->bytes > capacity_) return;
  std::list<Entry> dropped;  // destroyed without the lock
  const std::lock_guard lock(mutex_);
  if (const auto found = by_key_.find(key); found != by_key_.end()) {
    entries_.splice(entries_.begin(), entries_, found->second);  // the same mesh
    return;
  }
  for (auto each = entries_.end(); each != entries_.begin() && bytes_ + mesh->bytes > capacity_;) {
    const auto entry = std::prev(each);
    if (entry->second.use_count() > 1) {  // `find` alone gives it to readers, under the lock
      each = entry;
      continue;
    }
    bytes_ -= entry->second->bytes;
    by_key_.erase(entry->first);
    dropped.splice(dropped.begin(), entries_, entry);
  }
  if (bytes_ + mesh->bytes > capacity_) return;
  bytes_ += mesh->bytes;
  entries_.emplace_front(key, std::move(mesh));
  by_key_.emplace(key, entries_.begin());
}

std::uint64_t MeshCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace weft::server
