// SPDX-License-Identifier: Apache-2.0
// What a mesh was asked for, as far as the server keeps it: all but the arrays.
import { toJson } from "@bufbuild/protobuf";
import { GenerateMeshRequestSchema, Measure, type GenerateMeshRequest, type Summary } from "../gen/weft/v1/mesh_service_pb";
import { leavesOf } from "../compare/differences";
import { numberText } from "./summary-facts";

// Paths that have a row of their own above.
const told = /^size\.(constant|expression|measure)$|^domain\./;

function sizeText({ size }: GenerateMeshRequest): string {
  const what = size?.measure === Measure.EDGE ? "edges" : "areas";
  switch (size?.field.case) {
    case "constant":
      return `${what} of at most ${numberText(size.field.value)}`;
    case "expression":
      return size.field.value;
    case "raster":
      return `${what} by a raster of ${size.field.value.columns} × ${size.field.value.rows}`;
    default:
      return "no bound";
  }
}

export const requestJson = (request: GenerateMeshRequest) =>
  toJson(GenerateMeshRequestSchema, request, { useProtoFieldName: true });

export function RequestFacts({ summary }: { summary: Summary | undefined }) {
  if (!summary) return <p class="faint">Asking for it …</p>;
  const { request } = summary;
  if (!request) return <p class="faint">An earlier version of the server made this mesh, and did not keep its request.</p>;
  const others = [...leavesOf(requestJson(request))].filter(([path]) => !told.test(path));
  return (
    <dl class="facts">
      <div>
        <dt>Size</dt>
        <dd class={request.size?.field.case === "expression" ? "mono wrap" : undefined}>{sizeText(request)}</dd>
      </div>
      {request.domain && request.domain.snap > 0 && (
        <div>
          <dt>Snap</dt>
          <dd>{numberText(request.domain.snap)}</dd>
        </div>
      )}
      {others.map(([path, value]) => (
        <div key={path}>
          <dt class="mono">{path}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}
