// SPDX-License-Identifier: Apache-2.0
#include "server/admission/run_places.h"

#include <utility>

#include "server/admission/client_share.h"

namespace weft::server {

RunPlaces::RunPlaces(const Options& options)
    : main_{.places = options.places, .of_client = share_of(options.places, options.client_share)},
      light_{.places = options.light, .of_client = share_of(options.light, options.client_share)} {}

bool RunPlaces::is_free(Lane lane, Kind kind) const {
  const Places& in = at(lane);
  const bool others_turn =
      in.last == kind && in.waits[index(other(kind))] && Clock::now() - in.offered < kTurn;
  return has_place(lane) && !others_turn;
}

bool RunPlaces::has_share(Lane lane, const std::string& client) const {
  const Places& in = at(lane);
  const auto found = in.running_of.find(client);
  return found == in.running_of.end() || found->second < in.of_client;
}

std::vector<std::string> RunPlaces::full_clients(Lane lane) const {
  std::vector<std::string> full;
  for (const auto& [client, count] : at(lane).running_of)
    if (!client.empty() && count >= at(lane).of_client) full.push_back(client);
  return full;
}

void RunPlaces::begin(Lane lane, Kind kind, const std::string& client) {
  Places& in = at(lane);
  if (kind == Kind::kCall || !client.empty()) ++in.running_of[client];  // may find no memory
  ++in.running;
  in.last = kind;
}

void RunPlaces::end(Lane lane, Kind kind, const std::string& client) {
  Places& in = at(lane);
  bool frees = in.running-- >= in.places;
  in.offered = Clock::now();
  const auto found = in.running_of.find(client);
  if (found != in.running_of.end() && (kind == Kind::kCall || !client.empty())) {
    frees |= found->second >= in.of_client;
    if (--found->second == 0) in.running_of.erase(found);
  }
  if (frees) tell(other(kind));
}

void RunPlaces::set_waits(Lane lane, Kind kind, bool waits) {
  const bool did = std::exchange(at(lane).waits[index(kind)], waits);
  if (did && !waits) tell(other(kind));
}

void RunPlaces::on_free(Kind kind, std::function<void()> told) {
  told_[index(kind)] = std::move(told);
}

void RunPlaces::tell(Kind kind) const {
  if (const auto& told = told_[index(kind)]) told();
}

}  // namespace weft::server
