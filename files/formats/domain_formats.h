// SPDX-License-Identifier: Apache-2.0
// Domain files: which formats there are, and how each is read. docs/formats.md says what each
// carries. A mesh that can be read is a domain, too (mesh_domain.h).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "files/base/data_path.h"
#include "files/base/error.h"
#include "files/formats/domain.h"
#include "files/formats/layer_options.h"

namespace weft::files {

struct DomainFormat {
  std::string_view extension;  // lower case, ".gpkg"
  // weft's own reader, which is used unless layers or features are chosen; null: OGR reads it.
  Result<Domain> (*read)(const std::filesystem::path&, bool lonlat) = nullptr;
  // The same of a format whose layers and features it chooses itself.
  Result<Domain> (*read_layers)(const std::filesystem::path&, const LayerOptions&) = nullptr;
  // For GDALOpenEx, each a list that ends in null: the drivers that may read it, and how they open
  // it. Null of an archive, and of what OGR does not read.
  const char* const* drivers = nullptr;
  const char* const* driver_options = nullptr;
  bool is_archive = false;  // of files in other formats: ogr_archive.h
  // Of an archive: weft's own reader of the only file in it, in a format that it reads by itself.
  Result<Domain> (*read_archived)(const std::filesystem::path&, bool lonlat) = nullptr;
  bool needs_name = false;  // to be read: there are files beside it, or a library asks for the name

  // Whether weft's own reader reads it, from its file alone.
  bool is_own() const {
    return read_archived != nullptr || ((read != nullptr || read_layers != nullptr) && !needs_name);
  }
  bool has_layers() const { return drivers != nullptr || read_layers != nullptr || is_archive; }
};

// The format of an extension, in upper or lower case; null if there is none. A mesh is no such
// format.
const DomainFormat* domain_format(const DataPath& path);

// Reads a domain. Errors: kUsage for an unknown extension, and for one of a format without layers
// and attributes if `layers` wants some; kUnreadableInput for the rest, and for a domain with
// warnings if it is to be strict.
Result<Domain> read_domain(const DataPath& path, const LayerOptions& layers = {});

// Reads a stranger's file: by weft's own readers alone, which open no other file. Errors: kUsage
// for the extension of another format; kUnwritableOutput if there is no room to unpack it.
Result<Domain> read_own_domain(const DataPath& path, const LayerOptions& layers = {});
// ".poly, .geojson, ...": their extensions.
std::string own_domain_extensions();

// Whether the extension is that of a domain, or of a mesh that can be read as one.
bool is_domain_path(const DataPath& path);

// ".poly, .geojson, ...": the extensions of domains only.
std::string domain_extensions();
// Whether the extension is one of these.
bool is_plain_domain_path(const DataPath& path);

// "'.dxf' is not that of a domain: .poly, .geojson, ...; nor of a mesh: .vtu, ..." (kUsage).
tl::unexpected<Error> unknown_domain_format(const DataPath& path);

}  // namespace weft::files
