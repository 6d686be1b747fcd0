// SPDX-License-Identifier: Apache-2.0
#include "server/admission/run_places.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace weft::server {
namespace {

using Lane = RunPlaces::Lane;
using Kind = RunPlaces::Kind;

TEST(RunPlaces, AreAsManyForBothKindsTogether) {
  RunPlaces places({.places = 2, .light = 1});
  places.begin(Lane::kMain, Kind::kCall, "a");
  EXPECT_TRUE(places.is_free(Lane::kMain, Kind::kJob));
  places.begin(Lane::kMain, Kind::kJob, "b");
  EXPECT_FALSE(places.is_free(Lane::kMain, Kind::kJob));
  EXPECT_FALSE(places.is_free(Lane::kMain, Kind::kCall));
  EXPECT_TRUE(places.is_free(Lane::kLight, Kind::kCall));
  places.end(Lane::kMain, Kind::kJob, "b");
  EXPECT_TRUE(places.is_free(Lane::kMain, Kind::kCall));
}

TEST(RunPlaces, CountAClientsRunsOfBothKinds) {
  RunPlaces places({.places = 4, .client_share = 0.5});
  places.begin(Lane::kMain, Kind::kCall, "a");
  EXPECT_TRUE(places.has_share(Lane::kMain, "a"));
  places.begin(Lane::kMain, Kind::kJob, "a");
  EXPECT_FALSE(places.has_share(Lane::kMain, "a"));
  EXPECT_TRUE(places.has_share(Lane::kMain, "b"));
  EXPECT_EQ(places.full_clients(Lane::kMain), std::vector<std::string>{"a"});
  places.end(Lane::kMain, Kind::kCall, "a");
  EXPECT_TRUE(places.has_share(Lane::kMain, "a"));
}

TEST(RunPlaces, CountNoJobsOfNobody) {
  RunPlaces places({.places = 4, .client_share = 0.5});
  for (int i = 0; i < 3; ++i) places.begin(Lane::kMain, Kind::kJob, "");
  EXPECT_TRUE(places.has_share(Lane::kMain, ""));
  for (int i = 0; i < 3; ++i) places.end(Lane::kMain, Kind::kJob, "");
  EXPECT_EQ(places.running(Lane::kMain), 0u);
}

TEST(RunPlaces, KeepNoJobsOfNobodyFromCallsOfNobody) {
  RunPlaces places({.places = 4, .client_share = 0.5});
  for (int i = 0; i < 2; ++i) places.begin(Lane::kMain, Kind::kCall, "");
  EXPECT_TRUE(places.full_clients(Lane::kMain).empty());
}

TEST(RunPlaces, AreToldOfOnlyIfARunThatCouldNotBeginNowCan) {
  int told = 0;
  RunPlaces places({.places = 3});
  places.on_free(Kind::kJob, [&] { ++told; });
  for (const char* client : {"a", "b", "c"}) places.begin(Lane::kMain, Kind::kCall, client);
  places.end(Lane::kMain, Kind::kCall, "a");
  EXPECT_EQ(told, 1);  // the last place
  places.end(Lane::kMain, Kind::kCall, "b");
  EXPECT_EQ(told, 1);

  RunPlaces shared({.places = 4, .client_share = 0.5});
  shared.on_free(Kind::kJob, [&] { ++told; });
  for (int i = 0; i < 2; ++i) shared.begin(Lane::kMain, Kind::kCall, "a");
  shared.end(Lane::kMain, Kind::kCall, "a");
  EXPECT_EQ(told, 2);  // the last of a share
  shared.end(Lane::kMain, Kind::kCall, "a");
  EXPECT_EQ(told, 2);
}

TEST(RunPlaces, GoToTheKindsInTurnsIfBothWait) {
  RunPlaces places({.places = 1});
  places.begin(Lane::kMain, Kind::kCall, "a");
  for (const Kind kind : {Kind::kCall, Kind::kJob}) places.set_waits(Lane::kMain, kind, true);
  places.end(Lane::kMain, Kind::kCall, "a");
  std::string began;
  for (int i = 0; i < 6; ++i) {
    const bool call = places.is_free(Lane::kMain, Kind::kCall);
    EXPECT_NE(call, places.is_free(Lane::kMain, Kind::kJob));
    const Kind kind = call ? Kind::kCall : Kind::kJob;
    began += call ? 'c' : 'j';
    places.begin(Lane::kMain, kind, "a");
    places.end(Lane::kMain, kind, "a");
  }
  EXPECT_EQ(began, "jcjcjc");
}

TEST(RunPlaces, AreNotLeftToAKindThatNoLongerWaits) {
  RunPlaces places({.places = 1});
  int told = 0;
  places.on_free(Kind::kCall, [&] { ++told; });
  places.set_waits(Lane::kMain, Kind::kJob, true);
  places.begin(Lane::kMain, Kind::kCall, "a");
  places.end(Lane::kMain, Kind::kCall, "a");
  EXPECT_FALSE(places.is_free(Lane::kMain, Kind::kCall));
  EXPECT_EQ(told, 0);
  places.set_waits(Lane::kMain, Kind::kJob, false);
  EXPECT_EQ(told, 1);
  EXPECT_TRUE(places.is_free(Lane::kMain, Kind::kCall));
}

}  // namespace
}  // namespace weft::server
