// SPDX-License-Identifier: Apache-2.0
#include "engine/emit/digest.h"

#include <openssl/evp.h>

#include <bit>

namespace weft {

static_assert(std::endian::native == std::endian::little, "digests are of little-endian bytes");

Sha256::Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
  EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
}

void Sha256::add(const void* bytes, std::size_t size) {
  EVP_DigestUpdate(context_.get(), bytes, size);
}

Digest Sha256::finish() {
  Digest digest{};
  EVP_DigestFinal_ex(context_.get(), digest.data(), nullptr);
  return digest;
}

Digest chunk_digest(const Chunk& chunk) {
  Sha256 sha;
  sha.add(chunk.coordinates.data(), chunk.coordinates.size() * sizeof(double));
  sha.add(chunk.triangles.data(), chunk.triangles.size() * sizeof(std::uint32_t));
  if (chunk.regions.empty()) {
    const std::vector<std::int32_t> zeros(chunk.triangles.size() / 3);
    sha.add(zeros.data(), zeros.size() * sizeof(std::int32_t));
  } else {
    sha.add(chunk.regions.data(), chunk.regions.size() * sizeof(std::int32_t));
  }
  static_assert(sizeof(Chunk::Edge) == 16);
  sha.add(chunk.edges.data(), chunk.edges.size() * sizeof(Chunk::Edge));
  sha.add(chunk.input_points.data(), chunk.input_points.size() * 8);
  sha.add(chunk.bulges.data(), chunk.bulges.size() * sizeof(double));
  return sha.finish();
}

}  // namespace weft
