// SPDX-License-Identifier: Apache-2.0
// Says what keeps a page from showing what is true now. That the server is away, or needs a token, is
// said by the console's own banner, on every page.
import { Code, ConnectError } from "@connectrpc/connect";
import { explain } from "../client";
import { isAway } from "../errors";

export function messageOf(problem: unknown): string {
  const { code } = ConnectError.from(problem);
  if (code === Code.Unimplemented) return "This server keeps no jobs: it was started without --data and --store.";
  return explain(problem).sentence;
}

// Nothing if there is no problem.
export function Problem({ of }: { of: unknown }) {
  const said = of === undefined || isAway(of) || ConnectError.from(of).code === Code.Unauthenticated;
  return <div role="status">{!said && <p class="problem">{messageOf(of)}</p>}</div>;
}
