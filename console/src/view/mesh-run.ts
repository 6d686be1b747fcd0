// SPDX-License-Identifier: Apache-2.0
// A mesh that comes from the server, from any stream of chunks.
//
//   const run = useMeshRun();
//   run.start({ kind: "job", id });             // or { kind: "mesh", request }
//   <MeshView run={run} /> <MeshFigures run={run} /> <MeshSummary run={run} />
//   run.cancel();
import type { MessageInitShape } from "@bufbuild/protobuf";
import type { GenerateMeshRequestSchema } from "../gen/weft/v1/mesh_service_pb";

export type MeshSource =
  | { kind: "mesh"; request: MessageInitShape<typeof GenerateMeshRequestSchema> }
  | { kind: "job"; id: string };

export interface MeshRun {
  start(source: MeshSource): void;
  cancel(): void;
}
