// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/domain.h"

#include <exception>
#include <new>
#include <utility>

#include "engine/domain/arrangement/arrangement.h"
#include "engine/domain/carve.h"
#include "engine/domain/extract.h"
#include "engine/domain/outside.h"
#include "engine/domain/stop_poller.h"
#include "engine/domain/validate.h"

namespace weft {
namespace {

Result<Domain> run(const Pslg& pslg, StopPoller& poller) {
  poller.poll();
  if (auto error = validate(pslg, poller)) return tl::unexpected(*std::move(error));
  const Arrangement arrangement = arrange(pslg, poller);
  Result<Carving> carving = carve(arrangement, pslg, poller);
  if (!carving) return tl::unexpected(std::move(carving).error());
  carving->outside = find_outside(arrangement, *carving, pslg, poller);
  return extract(arrangement, *std::move(carving), poller);
}

}  // namespace

Result<Domain> triangulate(const Pslg& pslg, const ExecutionContext& context) {
  try {
    StopPoller poller(context);
    return run(pslg, poller);
  } catch (Stopped& stopped) {
    return tl::unexpected(std::move(stopped.error));
  } catch (const std::bad_alloc&) {
    return fail(ErrorCode::kOutOfMemory, "",
                "the machine has no memory left to triangulate the domain");
  } catch (const std::exception& e) {
    return fail(ErrorCode::kInternal, "", std::string("triangulating the domain: ") + e.what());
  }
}

}  // namespace weft
