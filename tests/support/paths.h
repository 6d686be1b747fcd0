// SPDX-License-Identifier: Apache-2.0
// Where the programs, and the files of the tree, lie that tests use. In a file of its own, so that
// the compiler's cache knows every other test in a clone elsewhere.
#pragma once

namespace weft::testing {

extern const char* const kWeft;
extern const char* const kWeftd;
extern const char* const kFakeWeftd;       // tests/client/support/fake_weftd.cpp
extern const char* const kHostileClients;  // tests/e2e/hostile/hostile_clients.cpp
extern const char* const kModels;          // the folder tests/models
extern const char* const kDeploy;          // the folder deploy

}  // namespace weft::testing
