// SPDX-License-Identifier: Apache-2.0
// SHA-256 of a mesh, computed incrementally. Not thread-safe.
#pragma once

#include <openssl/types.h>

#include <cstddef>
#include <memory>

#include "weft/mesh.h"

namespace weft {

class Sha256 {
 public:
  Sha256();
  void add(const void* bytes, std::size_t size);
  Digest finish();  // call once

 private:
  std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> context_;
};

}  // namespace weft
