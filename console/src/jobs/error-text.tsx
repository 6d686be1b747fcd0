// SPDX-License-Identifier: Apache-2.0
// Why a job failed.
import { anyUnpack } from "@bufbuild/protobuf/wkt";
import { BadRequestSchema, ErrorInfoSchema, RetryInfoSchema } from "../gen/google/rpc/error_details_pb";
import { Code } from "@connectrpc/connect";
import type { Status } from "../gen/google/rpc/status_pb";

// The reason of weft's table, such as BOUNDS_NOT_MET, or the name of the status.
export function reasonOf(error: Status): string {
  for (const detail of error.details) {
    const info = anyUnpack(detail, ErrorInfoSchema);
    if (info?.reason) return info.reason;
  }
  return Code[error.code] ?? `code ${error.code}`;
}

export function ErrorText({ error }: { error: Status }) {
  const fields = error.details.flatMap((detail) => anyUnpack(detail, BadRequestSchema)?.fieldViolations ?? []);
  const retry = error.details.some((detail) => anyUnpack(detail, RetryInfoSchema));
  return (
    <div class="error-text" role="alert">
      <strong>{reasonOf(error)}</strong>
      <p>{error.message}</p>
      {fields.length > 0 && (
        <dl class="facts">
          {fields.map(({ field, description }) => (
            <>
              <dt class="mono">{field}</dt>
              <dd>{description}</dd>
            </>
          ))}
        </dl>
      )}
      {retry && <p class="faint">The same request may succeed later.</p>}
    </div>
  );
}
