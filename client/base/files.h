// SPDX-License-Identifier: Apache-2.0
// The names of files/ as the client's own: most of what it does is with files.
#pragma once

namespace weft::files {}

namespace weft::client {
using namespace files;
}
