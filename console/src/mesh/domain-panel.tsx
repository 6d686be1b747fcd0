// SPDX-License-Identifier: Apache-2.0
// Where the domain comes from: an example, a file, or a drawing.
import { useEffect, useRef, useState } from "preact/hooks";
import { examples, type Example } from "../domain/examples";
import type { Finding } from "../domain/domain-file";
import { boxOf } from "../domain/outline";
import type { Domain } from "../gen/weft/v1/mesh_service_pb";
import { keep } from "../download/downloads";
import { choicesOf } from "../http";
import { count, figure } from "../text";

interface Props {
  name: string; // of the file that it is, or could be, in
  domain: Domain;
  text: string | undefined; // of the file, if it is not the person's own
  example: string | undefined; // its name
  findings: Finding[];
  faults: number; // of which the findings are some
  project: (() => void) | undefined; // from longitude and latitude
  reading: string | undefined; // the name of a file that is on its way
  problem: string | undefined;
  drawing: boolean;
  onExample: (example: Example) => void;
  onFile: (file: File) => void;
  onDraw: () => void;
}

const shown = 6; // findings

function Findings({ findings, faults, project }: Pick<Props, "findings" | "faults" | "project">) {
  const some = findings.slice(0, shown);
  return (
    <div class="problem findings" role="status">
      <ul>
        {some.map(({ text, remedy }) => <li>{remedy ? `${text}; ${remedy}` : text}</li>)}
        {faults > some.length && <li>{count(faults - some.length)} more: <code>weft lint</code> lists them</li>}
      </ul>
      {project && <button type="button" onClick={project}>Project it to metres</button>}
    </div>
  );
}

export function DomainPanel({ name, domain, text, example, findings, faults, project, reading, problem, drawing, onExample, onFile, onDraw }: Props) {
  const input = useRef<HTMLInputElement>(null);
  const [accepted, setAccepted] = useState("");
  useEffect(() => {
    choicesOf("from").then((formats) => setAccepted(formats.map((format) => `.${format}`).join(",")), () => {});
  }, []);
  const box = boxOf(domain);
  const size = box && `${figure(box[2] - box[0])} × ${figure(box[3] - box[1])}`;
  return (
    <section aria-labelledby="domain-title">
      <h2 id="domain-title">Domain</h2>
      <div class="chips" role="group" aria-label="Examples">
        {examples.map((each) => (
          <button type="button" aria-pressed={!drawing && each.name === example} onClick={() => onExample(each)}>
            {each.name}
          </button>
        ))}
      </div>
      <div class="row">
        <button type="button" class="wide" onClick={() => input.current!.click()}>
          Open a file…
        </button>
        <button type="button" class="wide" aria-pressed={drawing} onClick={onDraw}>
          Draw
        </button>
        <input
          ref={input}
          type="file"
          class="hidden"
          tabIndex={-1}
          aria-label="Domain file"
          accept={accepted}
          onChange={(event) => {
            const file = event.currentTarget.files?.[0];
            event.currentTarget.value = "";
            if (file) onFile(file);
          }}
        />
      </div>
      {reading && <p class="faint" role="status">The server reads {reading}…</p>}
      {problem && (
        <p class="problem" role="alert">
          {problem}
        </p>
      )}
      {!drawing && (
        <p class="faint domain-facts">
          <strong>{name}</strong>{" "}
          {text !== undefined && (
            <button type="button" class="link" onClick={() => keep(new Blob([text]), name)}>
              save
            </button>
          )}
          <br />
          {count(domain.points.length / 2)} points, {count(domain.segments.length / 2)} segments{size && `, ${size}`}
        </p>
      )}
      {!drawing && findings.length > 0 && <Findings findings={findings} faults={faults} project={project} />}
    </section>
  );
}
