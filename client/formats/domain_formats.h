// SPDX-License-Identifier: Apache-2.0
// Domain files: which formats there are, and how each is read. docs/formats.md says what each
// carries. A mesh that can be read is a domain, too (mesh_domain.h).
#pragma once

#include <filesystem>
#include <string>

#include "client/base/error.h"
#include "client/formats/domain.h"
#include "client/formats/files/layer_options.h"

namespace weft::client {

// Reads a domain. Errors: kUsage for an unknown extension, and for one of a format without layers
// and attributes if `layers` wants some; kUnreadableInput for the rest, and for a domain with
// warnings if it is to be strict.
Result<Domain> read_domain(const std::filesystem::path& path, const LayerOptions& layers = {});

// Whether the extension is that of a domain, or of a mesh that can be read as one.
bool is_domain_path(const std::filesystem::path& path);

// ".poly, .geojson, ...": the extensions of domains only.
std::string domain_extensions();
// Whether the extension is one of these.
bool is_plain_domain_path(const std::filesystem::path& path);

// "'.dxf' is not that of a domain: .poly, .geojson, ...; nor of a mesh: .vtu, ..." (kUsage).
tl::unexpected<Error> unknown_domain_format(const std::filesystem::path& path);

}  // namespace weft::client
