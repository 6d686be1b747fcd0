// SPDX-License-Identifier: Apache-2.0
// Certificates made on the spot.
//
//   TestCa ca("our CA");
//   const TestCertificate server = ca.issue({.common_name = "server", .names = {"DNS:localhost"}});
#pragma once

#include <openssl/evp.h>
#include <openssl/x509.h>

#include <memory>
#include <string>
#include <vector>

namespace weft::testing {

struct TestCertificate {
  std::string pem;
  std::string key;  // PEM
};

struct CertificateOptions {
  std::string common_name{};         // empty: none
  std::vector<std::string> names{};  // alternative names, as OpenSSL writes them: "DNS:localhost"
  int days = 1;                      // until it expires; -1: it expired yesterday
};

class TestCa {
 public:
  explicit TestCa(const std::string& name);

  const std::string& pem() const { return pem_; }
  TestCertificate issue(const CertificateOptions& options) const;

 private:
  using Key = std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)>;
  using X509Ptr = std::unique_ptr<X509, decltype(&X509_free)>;

  Key key_;
  X509Ptr certificate_;
  std::string pem_;
};

}  // namespace weft::testing
