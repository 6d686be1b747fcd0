// SPDX-License-Identifier: Apache-2.0
// Where the domain comes from: an example, a file, or a drawing.
import { useRef } from "preact/hooks";
import { examples, type Example } from "../domain/examples";
import { boxOf, type PlanarDomain } from "../domain/planar-domain";
import { extensions } from "../domain/read-domain";
import { count, figure } from "../text";

interface Props {
  domain: PlanarDomain;
  text: string | undefined; // of the file, if it is not the person's own
  example: string | undefined; // its name
  problem: string | undefined;
  drawing: boolean;
  onExample: (example: Example) => void;
  onFile: (file: File) => void;
  onDraw: () => void;
}

function save(name: string, text: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export function DomainPanel({ domain, text, example, problem, drawing, onExample, onFile, onDraw }: Props) {
  const input = useRef<HTMLInputElement>(null);
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
          accept={extensions.join(",")}
          onChange={(event) => {
            const file = event.currentTarget.files?.[0];
            event.currentTarget.value = "";
            if (file) onFile(file);
          }}
        />
      </div>
      {problem && (
        <p class="problem" role="alert">
          {problem}
        </p>
      )}
      {!drawing && (
        <p class="faint domain-facts">
          <strong>{domain.name}</strong>{" "}
          {text !== undefined && (
            <button type="button" class="link" onClick={() => save(domain.name, text)}>
              save
            </button>
          )}
          <br />
          {count(domain.points.length / 2)} points, {count(domain.markers.length)} segments{size && `, ${size}`}
        </p>
      )}
      {!drawing && domain.warnings.length > 0 && <p class="problem" role="status">{domain.warnings.join("; ")}</p>}
    </section>
  );
}
