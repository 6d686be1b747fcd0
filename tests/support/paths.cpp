// SPDX-License-Identifier: Apache-2.0
#include "tests/support/paths.h"

namespace weft::testing {

const char* const kWeft = WEFT_BINARIES "/weft";
const char* const kWeftd = WEFT_BINARIES "/weftd";
const char* const kFakeWeftd = WEFT_BINARIES "/weft_fake_weftd";
const char* const kHostileClients = WEFT_BINARIES "/hostile_clients";
const char* const kModels = WEFT_SOURCES "/tests/models";
const char* const kDeploy = WEFT_SOURCES "/deploy";

}  // namespace weft::testing
