// SPDX-License-Identifier: Apache-2.0
// A picture as the bytes that make a terminal show it, from the cursor on and with a line feed
// behind it.
#pragma once

#include <string>

#include "client/drawing/image.h"
#include "client/report/picture_terminal.h"
#include "files/base/error.h"

namespace weft::client {

// Sixels have at most 256 colours: those that are nearest to the picture's own. Errors: kInternal
// is cairo's. REQUIRES: the image is not empty.
Result<std::string> terminal_picture(const Image& image, PictureProtocol protocol);

}  // namespace weft::client
