// SPDX-License-Identifier: Apache-2.0
// The files of a mesh, which the server writes: of a job that it keeps, or of a request, whose mesh it makes again
// unless it has it still.
import { toBinary } from "@bufbuild/protobuf";
import { useEffect, useRef, useState } from "preact/hooks";
import { explain } from "../client";
import type { Job } from "../gen/weft/v1/job_service_pb";
import { GenerateMeshRequestSchema, type GenerateMeshRequest } from "../gen/weft/v1/mesh_service_pb";
import { ask, choicesOf } from "../http";
import { count } from "../text";

// Lets the browser keep a file.
export function keep(file: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(file);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

function fileOf(of: Job | GenerateMeshRequest, format: string, signal: AbortSignal): Promise<Response> {
  if (of.$typeName === "weft.v1.Job") return ask(`/v1/jobs/${of.id}/mesh?format=${format}`, { signal });
  const body = toBinary(GenerateMeshRequestSchema, of).slice();
  return ask(`/v1/mesh?format=${format}`, { method: "POST", headers: { "content-type": "application/x-protobuf" }, body, signal });
}

// `stem`: of the files' names.
export function Downloads({ of, stem }: { of: Job | GenerateMeshRequest; stem: string }) {
  const [formats, setFormats] = useState<string[]>([]);
  const [said, setSaid] = useState("");
  const [busy, setBusy] = useState<AbortController>();
  const select = useRef<HTMLSelectElement>(null);
  useEffect(() => void choicesOf("format").then(setFormats, (error: unknown) => setSaid(explain(error).sentence)), []);
  useEffect(() => () => busy?.abort(), [busy]);
  useEffect(() => setBusy(undefined), [of]);

  const download = async () => {
    const format = select.current!.value;
    const started = new AbortController();
    setBusy(started);
    setSaid("");
    try {
      const response = await fileOf(of, format, started.signal);
      keep(await response.blob(), `${stem}.${format}`);
      const warnings = response.headers.get("weft-warning");
      setSaid(`${count(Number(response.headers.get("weft-triangles")))} triangles written${warnings ? `; ${warnings}` : ""}`);
    } catch (error) {
      if (!started.signal.aborted) setSaid(explain(error).sentence);
    }
    setBusy((now) => (now === started ? undefined : now));
  };

  return (
    <div class="downloads" role="group" aria-label="Download">
      <span class="faint" role="status">{busy ? "The server writes…" : said}</span>
      {busy && <button type="button" class="quiet" onClick={() => setBusy(undefined)}>Stop</button>}
      <select ref={select} aria-label="Format" disabled={busy !== undefined}>
        {formats.map((format) => <option value={format}>.{format}</option>)}
      </select>
      <button type="button" disabled={busy !== undefined || formats.length === 0} onClick={() => void download()}>Download</button>
    </div>
  );
}
