// SPDX-License-Identifier: Apache-2.0
// A domain from a dropped or picked file: the server reads it, and finds its faults.
import { fromBinary } from "@bufbuild/protobuf";
import { base64Decode } from "@bufbuild/protobuf/wire";
import { DomainSchema, type Domain } from "../gen/weft/v1/mesh_service_pb";
import { ask } from "../http";

// A fault of the domain, or a warning of the reader: an element of the answer's "findings".
export interface Finding {
  kind: string; // such as "open-end"; or "warning"
  warning?: string; // of these the kind, such as "open-ring"
  text: string; // with the places in the file
  remedy?: string;
}

export interface FileDomain {
  domain: Domain;
  findings: Finding[]; // some of each kind
  faults: number; // all of them
}

// `inMetres`: the file is in longitude and latitude, and is projected.
export async function readFile(file: File, inMetres: boolean, signal: AbortSignal): Promise<FileDomain> {
  const path = `/v1/domain/${encodeURIComponent(file.name)}${inMetres ? "?to_metres" : ""}`;
  const answer = await ask(path, { method: "POST", body: file, signal });
  const { domain, findings, faults } = (await answer.json()) as Omit<FileDomain, "domain"> & { domain: string };
  return { domain: fromBinary(DomainSchema, base64Decode(domain)), findings, faults };
}
