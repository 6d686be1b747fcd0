// SPDX-License-Identifier: Apache-2.0
#include "client/cli/connect_flags.h"

#include <CLI/CLI.hpp>
#include <string>

namespace weft::client {

void add_server_flags(CLI::App& command, ConnectOptions& options, WithoutServer without) {
  command
      .add_option("--server", options.server,
                  std::string("Server to use: HOST:PORT or unix:PATH. ") +
                      (without == WithoutServer::kPrivate
                           ? "Default: a private weftd, started for this command"
                           : "Required, because a private weftd keeps no jobs"))
      ->envname("WEFT_SERVER")
      ->type_name("ADDR");

  CLI::Option_group& secure = *command.add_option_group("Security of the connection to --server");
  secure.add_flag("--tls", options.tls, "Encrypt, and trust the CAs that the system trusts")
      ->envname("WEFT_TLS");
  secure.add_option("--tls-ca", options.tls_ca, "Encrypt, and trust the CAs in this file (PEM)")
      ->envname("WEFT_TLS_CA")
      ->type_name("FILE");
  CLI::Option* cert =
      secure
          .add_option("--tls-cert", options.tls_cert, "Client certificate to identify with (PEM)")
          ->envname("WEFT_CLIENT_TLS_CERT")
          ->type_name("FILE");
  CLI::Option* key = secure
                         .add_option("--tls-key", options.tls_key,
                                     "Private key of the certificate in --tls-cert (PEM)")
                         ->envname("WEFT_CLIENT_TLS_KEY")
                         ->type_name("FILE");
  cert->needs(key);
  key->needs(cert);
  secure
      .add_option("--tls-server-name", options.tls_server_name,
                  "Name that the server's certificate must have. Default: the host of --server")
      ->envname("WEFT_TLS_SERVER_NAME")
      ->type_name("NAME");
  secure
      .add_option("--token-file", options.token_file,
                  "Read the bearer token from this file. Default: the token in WEFT_TOKEN, or none")
      ->envname("WEFT_TOKEN_FILE")
      ->type_name("FILE");
  secure
      .add_flag("--insecure", options.insecure,
                "Send the token unencrypted to another machine, where anyone may read it")
      ->envname("WEFT_CLIENT_INSECURE");
}

}  // namespace weft::client
