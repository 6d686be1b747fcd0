// SPDX-License-Identifier: Apache-2.0
#include "tests/support/certificates.h"

#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

#include <stdexcept>

namespace weft::testing {
namespace {

constexpr long kDay = 24 * 60 * 60;

void demand(bool good) {
  if (!good) throw std::runtime_error("OpenSSL cannot make a certificate");
}

EVP_PKEY* make_key() {
  EVP_PKEY* key = EVP_EC_gen("P-256");
  demand(key != nullptr);
  return key;
}

template <class Write>
std::string to_pem(Write&& write) {
  const std::unique_ptr<BIO, decltype(&BIO_free)> out(BIO_new(BIO_s_mem()), &BIO_free);
  demand(write(out.get()) == 1);
  const char* text = nullptr;
  const long size = BIO_get_mem_data(out.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}

std::string pem_of(X509* certificate) {
  return to_pem([&](BIO* out) { return PEM_write_bio_X509(out, certificate); });
}

void add_extension(X509* certificate, X509* issuer, int kind, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str());
  demand(extension != nullptr);
  demand(X509_add_ext(certificate, extension, -1) == 1);
  X509_EXTENSION_free(extension);
}

// Unsigned, valid for so many days from now.
X509* make_certificate(const std::string& common_name, EVP_PKEY* key, int days) {
  X509* certificate = X509_new();
  X509_set_version(certificate, X509_VERSION_3);
  long serial = 0;
  RAND_bytes(reinterpret_cast<unsigned char*>(&serial), 4);
  ASN1_INTEGER_set(X509_get_serialNumber(certificate), serial);
  X509_gmtime_adj(X509_getm_notBefore(certificate), -3 * kDay);
  X509_gmtime_adj(X509_getm_notAfter(certificate), days * kDay);
  X509_set_pubkey(certificate, key);
  if (!common_name.empty())
    X509_NAME_add_entry_by_txt(X509_get_subject_name(certificate), "CN", MBSTRING_ASC,
                               reinterpret_cast<const unsigned char*>(common_name.c_str()), -1, -1,
                               0);
  return certificate;
}

}  // namespace

TestCa::TestCa(const std::string& name)
    : key_(make_key(), &EVP_PKEY_free),
      certificate_(make_certificate(name, key_.get(), 1), &X509_free) {
  X509_set_issuer_name(certificate_.get(), X509_get_subject_name(certificate_.get()));
  add_extension(certificate_.get(), certificate_.get(), NID_basic_constraints, "critical,CA:TRUE");
  add_extension(certificate_.get(), certificate_.get(), NID_key_usage, "critical,keyCertSign");
  demand(X509_sign(certificate_.get(), key_.get(), EVP_sha256()) != 0);
  pem_ = pem_of(certificate_.get());
}

TestCertificate TestCa::issue(const CertificateOptions& options) const {
  const Key key(make_key(), &EVP_PKEY_free);
  const X509Ptr certificate(make_certificate(options.common_name, key.get(), options.days),
                            &X509_free);
  X509_set_issuer_name(certificate.get(), X509_get_subject_name(certificate_.get()));
  std::string names;
  for (const std::string& name : options.names) names += (names.empty() ? "" : ",") + name;
  if (!names.empty())
    add_extension(certificate.get(), certificate_.get(), NID_subject_alt_name, names);
  demand(X509_sign(certificate.get(), key_.get(), EVP_sha256()) != 0);
  return {pem_of(certificate.get()), to_pem([&](BIO* out) {
            return PEM_write_bio_PrivateKey(out, key.get(), nullptr, nullptr, 0, nullptr, nullptr);
          })};
}

}  // namespace weft::testing
