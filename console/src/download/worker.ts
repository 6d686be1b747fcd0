// SPDX-License-Identifier: Apache-2.0
// Fetches the mesh of a job and writes its file. The order starts it; the last news has the file, or
// says why there is none.
import { ConnectError, createClient } from "@connectrpc/connect";
import { createGrpcWebTransport } from "@connectrpc/connect-web";
import { JobService } from "../gen/weft/v1/job_service_pb";
import type { MeshNames } from "../domain/names";
import { formats, type Format } from "./formats";

export interface Order {
  job: string;
  format: Format;
  names: MeshNames;
  token: string; // empty: none
}

export type News = { triangles: number } | { file: Blob } | { problem: string };

const tell = (news: News) => postMessage(news);

async function fetchFile({ job, format, names, token }: Order): Promise<Blob> {
  const writer = formats[format].begin(names);
  let triangles = 0;
  let chunks = 0;
  let complete = false;
  const client = createClient(JobService, createGrpcWebTransport({ baseUrl: location.origin }));
  const headers: HeadersInit = token ? { authorization: `Bearer ${token}` } : {};
  for await (const { message } of client.fetchMesh({ id: job }, { headers })) {
    if (message.case === "chunk") {
      writer.add(message.value);
      triangles += message.value.triangles.length / 3;
      ++chunks;
      tell({ triangles });
    } else if (message.case === "summary") {
      complete = chunks === message.value.chunks && BigInt(triangles) === message.value.triangles;
    }
  }
  if (!complete) throw new Error("the stream ended before the mesh was complete");
  return writer.finish();
}

onmessage = async ({ data }: MessageEvent<Order>) => {
  try {
    tell({ file: await fetchFile(data) });
  } catch (error) {
    tell({ problem: ConnectError.from(error).rawMessage });
  }
};
