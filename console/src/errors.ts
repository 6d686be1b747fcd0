// SPDX-License-Identifier: Apache-2.0
// A failed call in words: the offender first, then what is wrong with it.
import { Code, ConnectError } from "@connectrpc/connect";
import { BadRequestSchema, ErrorInfoSchema, RetryInfoSchema } from "./gen/google/rpc/error_details_pb";

export interface Explanation {
  code: Code;
  sentence: string; // one line, such as "domain.segments[3].b: there is no point 9"
  message: string; // all that the server said; a fault in an expression has a caret in it
  fields: string[]; // paths in the request, such as "size.expression"
  reason: string; // of ErrorInfo, such as "INVALID_SIZE"; "" if there is none
  metadata: Record<string, string>; // of ErrorInfo
  retrySeconds: number | undefined;
}

const plain: Partial<Record<Code, string>> = {
  [Code.Canceled]: "The call was cancelled.",
  [Code.DeadlineExceeded]: "The time for this call is over.",
  [Code.Unauthenticated]: "The server needs a token.",
  [Code.PermissionDenied]: "This token may not do that.",
  [Code.NotFound]: "The server does not have it.",
  [Code.ResourceExhausted]: "That is more than the server allows.",
  [Code.Unimplemented]: "This server does not offer that.",
  [Code.Unavailable]: "The server does not answer.",
};

export function explain(error: unknown): Explanation {
  const failure = ConnectError.from(error);
  const info = failure.findDetails(ErrorInfoSchema)[0];
  const bad = failure.findDetails(BadRequestSchema)[0];
  const retry = failure.findDetails(RetryInfoSchema)[0];
  const fields = bad?.fieldViolations.map((violation) => violation.field) ?? [];
  const message = isAway(failure) ? plain[Code.Unavailable]! : failure.rawMessage || plain[failure.code] || "";
  const first = message.split("\n", 1)[0];
  const place = fields.length > 0 && !first.startsWith(fields[0]) ? `${fields[0]}: ` : "";
  return {
    code: failure.code,
    sentence: place + (first || `The server answered ${Code[failure.code]}.`),
    message,
    fields,
    reason: info?.reason ?? "",
    metadata: { ...info?.metadata },
    retrySeconds: retry?.retryDelay
      ? Number(retry.retryDelay.seconds) + retry.retryDelay.nanos / 1e9
      : undefined,
  };
}

// Whether the server did not answer at all, or is about to stop.
export function isAway(error: unknown): boolean {
  const failure = ConnectError.from(error);
  if (failure.code === Code.Unavailable) return true;
  return /failed to fetch|networkerror|load failed|network error/i.test(failure.rawMessage);
}
