// SPDX-License-Identifier: Apache-2.0
#include "client/commands/input_domain.h"

#include <utility>

#include "client/formats/domain_formats.h"
#include "client/formats/raster.h"
#include "client/report/projection_report.h"

namespace weft::client {

Result<InputDomain> read_input_domain(const std::filesystem::path& path, const RequestOptions& size,
                                      const ProjectionOptions& options) {
  const std::string& grid = size.edge.empty() ? size.size : size.edge;
  if (options.wanted() && options.crs.empty() && is_raster_path(grid))
    return fail(ExitCode::kUsage,
                grid +
                    ": a grid of sizes lies in the plane of the projection, so the projection "
                    "needs a name: give --crs CODE, and a grid in its metres");
  auto domain = read_domain(path);
  if (!domain) return tl::unexpected(domain.error());
  InputDomain input{std::move(*domain), nullptr};
  if (!options.wanted()) return input;
  auto projection = DomainProjection::project(input.domain, options);
  if (!projection)
    return fail(projection.error().exit, path.string() + ": " + projection.error().message);
  input.projection = std::make_shared<const DomainProjection>(std::move(*projection));
  return input;
}

Error in_plane(Error error, const InputDomain& input) {
  constexpr int kInvalidArgument = 3;
  constexpr int kFailedPrecondition = 9;
  if (input.projection && (error.exit == exit_code_of_status(kInvalidArgument) ||
                           error.exit == exit_code_of_status(kFailedPrecondition)))
    error.message += "\n  places are in metres of " + input.projection->name();
  return error;
}

void add_projection(const InputDomain& input, MeshReport& report) {
  if (!input.projection) return;
  report.projection = input.projection;
  const auto warnings = input.projection->warnings();
  report.warnings.insert(report.warnings.end(), warnings.begin(), warnings.end());
  if (!input.projection->to_metres()) bring_places_back(*input.projection, report.summary);
}

}  // namespace weft::client
