// SPDX-License-Identifier: Apache-2.0
// What the mesh must satisfy.
import type { ComponentChildren } from "preact";
import type { FormText, Problems } from "../request/form";
import { ProblemText } from "./problem-text";

interface Props {
  form: FormText;
  problems: Problems;
  onChange: (change: Partial<FormText>) => void;
}

function Problem({ id, text }: { id: string; text: string | undefined }) {
  if (!text) return null;
  return (
    <div class="problem" role="alert" id={id}>
      <ProblemText text={text} />
    </div>
  );
}

type NumberField = Exclude<keyof FormText, "gradationWithin">;

export function MeshForm({ form, problems, onChange }: Props) {
  const field = (name: NumberField, label: string, placeholder: string, hint: string) => (
    <div class="field">
      <label for={name} title={hint}>
        {label}
      </label>
      <input
        id={name}
        inputMode="decimal"
        autocomplete="off"
        value={form[name]}
        placeholder={placeholder}
        title={hint}
        aria-invalid={problems[name] !== undefined}
        aria-describedby={problems[name] ? `${name}-problem` : undefined}
        onInput={(event) => onChange({ [name]: event.currentTarget.value })}
      />
      <Problem id={`${name}-problem`} text={problems[name]} />
    </div>
  );
  const kinds: [FormText["sizeKind"], ComponentChildren][] = [
    ["edge", "Edge length"],
    ["area", "Area"],
    ["none", "No bound"],
  ];
  return (
    <>
      <fieldset>
        <legend>Size</legend>
        <div class="segmented">
          {kinds.map(([kind, text]) => (
            <label>
              <input
                type="radio"
                name="size-kind"
                checked={form.sizeKind === kind}
                onChange={() => onChange({ sizeKind: kind })}
              />
              <span>{text}</span>
            </label>
          ))}
        </div>
        {form.sizeKind !== "none" && (
          <>
            <textarea
              id="size"
              rows={2}
              spellcheck={false}
              aria-label={form.sizeKind === "edge" ? "Length of edges" : "Area of triangles"}
              aria-invalid={problems.size !== undefined}
              aria-describedby={problems.size ? "size-problem size-hint" : "size-hint"}
              value={form.size}
              onInput={(event) => onChange({ size: event.currentTarget.value })}
              onKeyDown={(event) => {
                if (event.key !== "Enter" || event.shiftKey || event.ctrlKey || event.metaKey) return;
                event.preventDefault();
                event.currentTarget.form?.requestSubmit();
              }}
            />
            <Problem id="size-problem" text={problems.size} />
            <p id="size-hint" class="faint hint">
              A number, or an expression in <code>x</code>, <code>y</code>, <code>distance</code> to the nearest segment
              and local <code>width</code>.
            </p>
          </>
        )}
        {field("gradation", "Gradation", "no limit", "How fast edges may grow per unit of length, such as 0.2")}
        {form.gradation.trim() !== "" && (
          <label title="Distances for the gradation are measured around land, not across it">
            <input
              type="checkbox"
              id="gradationWithin"
              checked={form.gradationWithin}
              onChange={(event) => onChange({ gradationWithin: event.currentTarget.checked })}
            />
            within the domain
          </label>
        )}
        {field("cellsAcross", "Edges across", "no bound", "At least this many edges across every channel")}
      </fieldset>
      <fieldset>
        <legend>Quality</legend>
        <div class="field">
          <label for="minAngle">Smallest angle</label>
          <span class="angle">
            <input
              type="range"
              min="0"
              max="36"
              step="0.5"
              aria-label="Smallest angle in degrees, as a slider"
              value={form.minAngle}
              onInput={(event) => onChange({ minAngle: event.currentTarget.value })}
            />
            <input
              id="minAngle"
              inputMode="decimal"
              autocomplete="off"
              value={form.minAngle}
              aria-invalid={problems.minAngle !== undefined}
              onInput={(event) => onChange({ minAngle: event.currentTarget.value })}
            />
            °
          </span>
          <Problem id="minAngle-problem" text={problems.minAngle} />
        </div>
        <details>
          <summary>More</summary>
          <div class="field">
            <label for="placement">Points</label>
            <select
              id="placement"
              value={form.placement}
              onChange={(event) => onChange({ placement: event.currentTarget.value as FormText["placement"] })}
            >
              <option value="lattice">on a lattice</option>
              <option value="circumcentre">at circumcentres</option>
            </select>
          </div>
          {field("maxTriangles", "Triangles, at most", "no limit", "Refinement stops there")}
          {field("snap", "Snap", "0", "Features nearer together than this are merged first")}
        </details>
      </fieldset>
    </>
  );
}
