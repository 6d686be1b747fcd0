// SPDX-License-Identifier: Apache-2.0
// The server's services, as gRPC-Web on the origin that the page comes from. Every call carries the
// token; the page's banner and its question for a token follow from how calls end.
import { createClient, Code, ConnectError, type Interceptor } from "@connectrpc/connect";
import { createGrpcWebTransport } from "@connectrpc/connect-web";
import { isAway } from "./errors";
import { JobService } from "./gen/weft/v1/job_service_pb";
import { MeshService } from "./gen/weft/v1/mesh_service_pb";
import { currentSession, updateSession } from "./session";

export { explain, type Explanation } from "./errors";

const authorize: Interceptor = (next) => async (request) => {
  const { token } = currentSession();
  if (token) request.header.set("authorization", `Bearer ${token}`);
  try {
    const response = await next(request);
    updateSession({ away: undefined });
    return response;
  } catch (error) {
    noteFailure(error);
    throw error;
  }
};

// `fetch` without credentials: a token is all that the server knows a caller by.
export const transport = createGrpcWebTransport({ baseUrl: location.origin, interceptors: [authorize] });
export const meshes = createClient(MeshService, transport);
export const jobs = createClient(JobService, transport);

let probing = false;

// Call with the error of a call that did not go through this file's clients, such as a worker's.
export function noteFailure(error: unknown): void {
  if (ConnectError.from(error).code === Code.Unauthenticated) updateSession({ tokenWanted: true, away: undefined });
  if (!isAway(error)) return;
  updateSession({ away: ConnectError.from(error).rawMessage });
  if (!probing) void probe();
}

// Asks until the server answers; the banner goes by itself.
async function probe(): Promise<void> {
  probing = true;
  for (let pause = 500; currentSession().away !== undefined; pause = Math.min(2 * pause, 5000)) {
    await new Promise((resolve) => setTimeout(resolve, pause));
    await meshes.getServerInfo({}, { timeoutMs: 5000 }).catch((error: unknown) => {
      if (!isAway(error)) updateSession({ away: undefined });
    });
  }
  probing = false;
}
