// SPDX-License-Identifier: Apache-2.0
#include "client/formats/domain_formats.h"

#include <new>
#include <stdexcept>
#include <string_view>

#include "client/base/text.h"
#include "client/formats/derived/mesh_domain.h"
#include "client/formats/domains/csv_rings.h"
#include "client/formats/domains/geojson.h"
#include "client/formats/domains/ogr.h"
#include "client/formats/domains/ogr_formats.h"
#include "client/formats/domains/shapefile.h"
#include "client/formats/domains/wkt.h"
#include "client/formats/mesh_formats.h"
#include "client/formats/triangle/triangle_poly.h"

namespace weft::client {
namespace {

struct DomainFormat {
  std::string_view extension;  // lower case
  Result<Domain> (*read)(const std::filesystem::path&, bool lonlat);
};

// Its segments are no rings.
Result<Domain> read_poly(const std::filesystem::path& path, bool) {
  return read_triangle_poly(path);
}

constexpr DomainFormat kFormats[] = {
    {".poly", read_poly}, {".geojson", read_geojson}, {".json", read_geojson},
    {".wkt", read_wkt},   {".shp", read_shapefile},   {".csv", read_csv_rings},
};

const DomainFormat* domain_format(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  for (const DomainFormat& format : kFormats)
    if (format.extension == extension) return &format;
  return nullptr;
}

std::string layered_extensions() {
  std::string list;
  for (const OgrFormat& format : ogr_formats())
    list += (list.empty() ? "" : ", ") + std::string(format.extension);
  return list;
}

bool is_read_as_mesh(const std::filesystem::path& path) {
  const MeshFormat* format = mesh_format(path);
  return format != nullptr && format->read != nullptr;
}

}  // namespace

bool is_plain_domain_path(const std::filesystem::path& path) {
  return domain_format(path) != nullptr || ogr_format(lower_extension(path)) != nullptr;
}

bool is_domain_path(const std::filesystem::path& path) {
  return is_plain_domain_path(path) || is_read_as_mesh(path);
}

std::string domain_extensions() {
  std::string list;
  for (const DomainFormat& format : kFormats)
    list += (list.empty() ? "" : ", ") + std::string(format.extension);
  for (const OgrFormat& format : ogr_formats())
    if (!format.own_reader) list += ", " + std::string(format.extension);
  return list;
}

tl::unexpected<Error> unknown_domain_format(const std::filesystem::path& path) {
  return fail(ExitCode::kUsage,
              path.string() + ": the extension " + in_quotes(path.extension().string()) +
                  " is not that of a domain: " + domain_extensions() +
                  "; nor of a mesh that is read as one: " + read_mesh_extensions());
}

namespace {

Result<Domain> read_any(const std::filesystem::path& path, const LayerOptions& layers) {
  if (!is_domain_path(path)) return unknown_domain_format(path);
  const OgrFormat* ogr = ogr_format(lower_extension(path));
  if (layers.wanted() && ogr == nullptr)
    return fail(ExitCode::kUsage, path.string() +
                                      ": --layer, --where and --attribute are for files "
                                      "with layers and attributes: " +
                                      layered_extensions());
  try {
    if (ogr != nullptr && (layers.wanted() || !ogr->own_reader)) return read_with_ogr(path, layers);
    if (const DomainFormat* format = domain_format(path)) return format->read(path, layers.lonlat);
    const auto mesh = read_mesh(path);
    if (!mesh) return tl::unexpected(mesh.error());
    Domain domain = domain_of_mesh(path.string(), mesh->view());
    domain.warnings.insert(domain.warnings.begin(), mesh->warnings.begin(), mesh->warnings.end());
    return domain;
  } catch (const std::bad_alloc&) {
  } catch (const std::length_error&) {
  }
  return fail(ExitCode::kUnreadableInput, path.string() + ": not enough memory to read it");
}

}  // namespace

Result<Domain> read_domain(const std::filesystem::path& path, const LayerOptions& layers) {
  auto domain = read_any(path, layers);
  if (!domain || !layers.strict || domain->warnings.empty()) return domain;
  std::string message = path.string() + ": refused, because of --strict";
  for (const Warning& warning : domain->warnings) message += "\n  " + warning.sentence();
  return fail(ExitCode::kUnreadableInput, message);
}

}  // namespace weft::client
