// SPDX-License-Identifier: Apache-2.0
// What can be done with a drawing.
import type { Sketch } from "../view/sketch";

export function SketchBar({ sketch, onDone, onCancel }: { sketch: Sketch; onDone: () => void; onCancel: () => void }) {
  const { ring, rings } = sketch;
  const corners = `${ring.length} ${ring.length === 1 ? "corner" : "corners"}`;
  const text =
    ring.length > 0
      ? ring.length < 3
        ? `${corners}. A ring has three at least.`
        : `${corners}. Click the first one to close the ring.`
      : rings.length === 0
        ? "Click to set the corners of a polygon."
        : "Draw a hole inside, or another polygon, or press Use.";
  return (
    <div class="sketch-bar" role="group" aria-label="Drawing">
      <span role="status">{text}</span>
      <button type="button" disabled={ring.length === 0 && rings.length === 0} onClick={() => sketch.undo()}>
        Undo
      </button>
      <button type="button" disabled={ring.length < 3} onClick={() => sketch.close()}>
        Close ring
      </button>
      <button type="button" onClick={onCancel}>
        Cancel
      </button>
      <button type="button" class="primary" disabled={rings.length === 0 && ring.length < 3} onClick={onDone}>
        Use
      </button>
    </div>
  );
}
