// SPDX-License-Identifier: Apache-2.0
// The functions of libpq that weftd calls, from the shared library, which is loaded when a store in
// PostgreSQL is first opened and stays.
#pragma once

#include <libpq-fe.h>

#include "loader/function_table.h"
#include "server/store/store_error.h"

#define WEFT_LIBPQ_FUNCTIONS(EACH) \
  EACH(PQclear)                    \
  EACH(PQcmdTuples)                \
  EACH(PQconnectdbParams)          \
  EACH(PQconsumeInput)             \
  EACH(PQerrorMessage)             \
  EACH(PQfinish)                   \
  EACH(PQflush)                    \
  EACH(PQfreemem)                  \
  EACH(PQgetResult)                \
  EACH(PQgetisnull)                \
  EACH(PQgetlength)                \
  EACH(PQgetvalue)                 \
  EACH(PQisBusy)                   \
  EACH(PQnotifies)                 \
  EACH(PQntuples)                  \
  EACH(PQresultErrorField)         \
  EACH(PQresultErrorMessage)       \
  EACH(PQresultStatus)             \
  EACH(PQsendQuery)                \
  EACH(PQsendQueryParams)          \
  EACH(PQsetNoticeProcessor)       \
  EACH(PQsetnonblocking)           \
  EACH(PQsocket)                   \
  EACH(PQstatus)

namespace weft::server::postgres {

WEFT_FUNCTION_TABLE(LibPq, WEFT_LIBPQ_FUNCTIONS);

// Errors (kBroken) name the library and why it is not loaded.
StoreResult<void> load_libpq();
// REQUIRES: load_libpq succeeded.
const LibPq& libpq();

}  // namespace weft::server::postgres
