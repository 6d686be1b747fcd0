// SPDX-License-Identifier: Apache-2.0
#include "client/commands/input_domain.h"

#include <utility>

#include "client/report/mesh_text.h"
#include "client/report/projection_report.h"
#include "files/formats/domain_formats.h"
#include "files/formats/raster.h"

namespace weft::client {

Result<InputDomain> read_input_domain(const DataPath& path, const RequestOptions& wanted,
                                      const ProjectionOptions& options, const LayerOptions& layers,
                                      const std::function<void(const Domain&)>& as_read) {
  const std::string& grid = wanted.edge.empty() ? wanted.size : wanted.edge;
  if (options.wanted() && options.crs.empty() && is_raster_path(grid))
    return fail(ExitCode::kUsage,
                grid +
                    ": a grid of sizes lies in the plane of the projection, so the projection "
                    "needs a name: give --crs CODE, and a grid in its metres");
  LayerOptions how = layers;
  how.lonlat = options.wanted();
  how.even_odd = wanted.fill == PolygonFill::kEvenOdd;
  auto domain = read_domain(path, how);
  if (!domain) return tl::unexpected(domain.error());
  if (auto named = set_names(wanted.names, domain->names); !named)
    return tl::unexpected(named.error());
  fill_polygons(*domain, wanted.fill);
  if (as_read) as_read(*domain);
  auto input = projected(path, std::move(*domain), options, wanted.asked.domain().snap());
  if (input && layers.strict) input->strict = path;
  return input;
}

Result<InputDomain> projected(const std::filesystem::path& path, Domain domain,
                              const ProjectionOptions& options, double snap) {
  InputDomain input{std::move(domain), nullptr};
  auto projection = DomainProjection::project_file(path, input.domain, options, snap);
  if (!projection) return tl::unexpected(projection.error());
  input.projection = std::move(*projection);
  return input;
}

RequestOrigin origin_of(const InputDomain& input, const RequestOptions* options) {
  return {&input.domain, options, input.projection.get()};
}

void add_projection(const InputDomain& input, MeshReport& report) {
  if (!input.projection) return;
  report.projection = input.projection;
  const auto warnings = input.projection->warnings();
  report.warnings.insert(report.warnings.end(), warnings.begin(), warnings.end());
  if (!input.projection->to_metres()) bring_places_back(*input.projection, report.summary);
}

Result<void> add_outside_warning(const InputDomain* input, MeshReport& report) {
  if (!report.summary.has_outside()) return {};
  std::string warning = outside_warning(report.summary);
  if (input != nullptr && !input->strict.empty())
    return fail(ExitCode::kUnreadableInput,
                input->strict.string() + ": refused, because of --strict\n  " + warning);
  add_warnings({std::move(warning)}, report);
  return {};
}

}  // namespace weft::client
