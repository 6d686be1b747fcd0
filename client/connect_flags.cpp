// SPDX-License-Identifier: Apache-2.0
#include "client/connect_flags.h"

#include <CLI/CLI.hpp>
#include <string>

namespace weft::client {

void add_server_flags(CLI::App& command, ConnectOptions& options, WithoutServer without) {
  command
      .add_option(
          "--server", options.server,
          std::string("Server to use, as HOST:PORT or unix:PATH. ") +
              (without == WithoutServer::kPrivate ? "Without one a private weftd is started"
                                                  : "Needed: a private weftd keeps no jobs"))
      ->envname("WEFT_SERVER")
      ->type_name("ADDR");

  CLI::Option_group& secure = *command.add_option_group("Security, of a server that is named");
  secure.add_flag("--tls", options.tls, "Encrypt, and trust whom the system trusts")
      ->envname("WEFT_TLS");
  secure.add_option("--tls-ca", options.tls_ca, "Encrypt, and trust these certificates, PEM")
      ->envname("WEFT_TLS_CA")
      ->type_name("FILE");
  CLI::Option* cert =
      secure.add_option("--tls-cert", options.tls_cert, "Own certificate for the server, PEM")
          ->envname("WEFT_TLS_CERT")
          ->type_name("FILE");
  CLI::Option* key = secure.add_option("--tls-key", options.tls_key, "Its private key, PEM")
                         ->envname("WEFT_TLS_KEY")
                         ->type_name("FILE");
  cert->needs(key);
  key->needs(cert);
  secure
      .add_option("--tls-server-name", options.tls_server_name,
                  "Name in the server's certificate. Default: the host of --server")
      ->envname("WEFT_TLS_SERVER_NAME")
      ->type_name("NAME");
  secure
      .add_option("--token-file", options.token_file,
                  "File that holds the bearer token. Default: the token in WEFT_TOKEN, or none")
      ->envname("WEFT_TOKEN_FILE")
      ->type_name("FILE");
  secure
      .add_flag("--insecure", options.insecure,
                "Send the token unencrypted to another machine, where anyone may read it")
      ->envname("WEFT_INSECURE");
}

}  // namespace weft::client
