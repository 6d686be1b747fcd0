// SPDX-License-Identifier: Apache-2.0
// What is wrong with a request, as application/problem+json has it.
//
//   {"type": "urn:weft:error:UNREADABLE_FILE", "title": "Bad Request", "status": 400,
//    "reason": "UNREADABLE_FILE", "detail": "coast.geojson:3:14: expected a number",
//    "errors": [{"place": "coast.geojson:3:14", "line": 3, "column": 14}]}
//
// Source: RFC 9457.
#pragma once

#include <grpcpp/support/status.h>

#include <string>

#include "server/console/pages.h"

namespace weft::server {

struct Problem {
  unsigned status = 500;
  std::string reason{};  // as in wire/errors.h, or one of HTTP's own
  std::string detail{};  // a sentence
  std::string field{};   // of the request, or the parameter, that is at fault
  std::string place{};   // in the file: "coast.geojson:3:14"
  bool retry = false;    // the same request may succeed later
};

Response problem_page(const Problem& problem);

// REQUIRES: the status is not OK.
Problem problem_of(const grpc::Status& status);

}  // namespace weft::server
