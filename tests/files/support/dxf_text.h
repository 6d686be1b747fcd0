// SPDX-License-Identifier: Apache-2.0
// Drawings in DXF for tests.
#pragma once

#include <string>

namespace weft::files {

// A drawing of these entities, pairs of a code and a value in one string.
inline std::string drawing(const std::string& entities, const std::string& blocks = "") {
  std::string text;
  for (const char c :
       "0 SECTION 2 HEADER 9 $ACADVER 1 AC1015 0 ENDSEC 0 SECTION 2 TABLES 0 TABLE 2 LAYER 70 1 0 "
       "LAYER 2 0 70 0 62 7 6 CONTINUOUS 0 ENDTAB 0 ENDSEC 0 SECTION 2 BLOCKS " +
           blocks + "0 ENDSEC 0 SECTION 2 ENTITIES " + entities + "0 ENDSEC 0 EOF ")
    text += c == ' ' ? '\n' : c;
  return text;
}

}  // namespace weft::files
