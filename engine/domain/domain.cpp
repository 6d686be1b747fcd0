// SPDX-License-Identifier: Apache-2.0
#include "engine/domain/domain.h"

#include <exception>
#include <new>
#include <utility>

#include "engine/domain/arcs/chords.h"
#include "engine/domain/arrangement/arrangement.h"
#include "engine/domain/carve.h"
#include "engine/domain/extract.h"
#include "engine/domain/outside.h"
#include "engine/domain/stop_poller.h"
#include "engine/domain/validate.h"

namespace weft {
namespace {

Result<Domain> triangulate_straight(const Pslg& pslg, StopPoller& poller) {
  const Arrangement arrangement = arrange(pslg, poller);
  Result<Carving> carving = carve(arrangement, pslg, poller);
  if (!carving) return tl::unexpected(std::move(carving).error());
  carving->outside = find_outside(arrangement, *carving, pslg, poller);
  return extract(arrangement, *std::move(carving), poller);
}

Result<Domain> run(const Pslg& pslg, double max_turn_deg, StopPoller& poller) {
  constexpr double kRadians = 0.017453292519943295;
  poller.poll();
  if (auto error = validate(pslg, poller)) return tl::unexpected(*std::move(error));
  if (pslg.arcs.empty()) return triangulate_straight(pslg, poller);
  const Chords chords = cut_arcs(pslg, kRadians * max_turn_deg, poller);
  Result<Domain> domain = triangulate_straight(chords.pslg, poller);
  if (domain) restore_arcs(chords, pslg, *domain, poller);
  return domain;
}

}  // namespace

Result<Domain> triangulate(const Pslg& pslg, const ExecutionContext& context, double max_turn_deg) {
  try {
    StopPoller poller(context);
    return run(pslg, max_turn_deg, poller);
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
