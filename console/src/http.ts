// SPDX-License-Identifier: Apache-2.0
// What the server answers under /v1/, beside its services: docs/http.md.
import { noteFailure } from "./client";
import { currentSession, updateSession } from "./session";

// Throws the sentence of a problem, with its place in a file if it has one.
export async function ask(path: string, init: RequestInit = {}): Promise<Response> {
  const headers = new Headers(init.headers);
  const { token } = currentSession();
  if (token) headers.set("authorization", `Bearer ${token}`);
  const response = await fetch(path, { ...init, headers, credentials: "omit" }).catch((error: unknown) => {
    noteFailure(error);
    throw error;
  });
  updateSession({ away: undefined });
  if (response.ok) return response;
  if (response.status === 401) updateSession({ tokenWanted: true });
  const { detail } = (await response.json().catch(() => ({}))) as { detail?: string };
  throw new Error(detail ?? `the server answered ${response.status}`);
}

interface Parameter {
  name: string;
  schema: { enum?: string[] };
}

let parameters: Promise<Parameter[]> | undefined;

// What the server takes for a parameter of a mesh: "from", the formats of domains; "format", those of meshes.
export async function choicesOf(name: "from" | "format"): Promise<string[]> {
  parameters ??= ask("/v1/openapi.json").then(async (response) => {
    const { paths } = (await response.json()) as { paths: Record<string, Record<string, { parameters: Parameter[] }>> };
    return paths["/v1/mesh"].post.parameters;
  });
  parameters.catch(() => (parameters = undefined));
  return (await parameters).find((parameter) => parameter.name === name)?.schema.enum ?? [];
}
