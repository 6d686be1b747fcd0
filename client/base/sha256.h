// SPDX-License-Identifier: Apache-2.0
// SHA-256, computed incrementally.
#pragma once

#include <openssl/evp.h>

#include <array>
#include <cstddef>
#include <memory>
#include <string>

namespace weft::client {

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new()) { restart(); }

  void add(const void* bytes, std::size_t size) {
    if (size > 0) EVP_DigestUpdate(context_.get(), bytes, size);
  }
  // Returns the digest, 32 bytes, and starts a new one.
  std::string finish() {
    std::string digest(32, '\0');
    EVP_DigestFinal_ex(context_.get(), reinterpret_cast<unsigned char*>(digest.data()), nullptr);
    restart();
    return digest;
  }

 private:
  struct Free {
    void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
  };
  void restart() { EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr); }

  std::unique_ptr<EVP_MD_CTX, Free> context_;
};

}  // namespace weft::client
