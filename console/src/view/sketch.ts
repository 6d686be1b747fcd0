// SPDX-License-Identifier: Apache-2.0
// A polygon with holes, drawn by hand: corners are set one by one, a ring ends at its first corner.
// Rings within the first are holes.
import type { Camera } from "./camera";

type Point = [x: number, y: number];

const near = 12; // pixels: a corner set nearer to the ring's first one closes it

export class Sketch {
  readonly rings: Point[][] = [];
  ring: Point[] = [];
  cursor: Point | undefined;

  // `changed` is called after every change but the cursor's.
  constructor(private readonly changed: () => void) {}

  // Sets a corner at a point of the plane, at `scale` pixels per unit.
  set(at: Point, scale: number): void {
    const [first] = this.ring;
    const last = this.ring.at(-1);
    if (last && last[0] === at[0] && last[1] === at[1]) return;
    if (first && Math.hypot(at[0] - first[0], at[1] - first[1]) * scale < near) return this.close();
    this.ring.push(at);
    this.changed();
  }

  // Nothing if the ring has fewer than three corners.
  close(): void {
    if (this.ring.length < 3) return;
    this.rings.push(this.ring);
    this.ring = [];
    this.changed();
  }

  // Takes the last corner back, or opens the last ring again.
  undo(): void {
    if (this.ring.length > 0) this.ring.pop();
    else this.ring = this.rings.pop() ?? [];
    this.changed();
  }

  paint(on: CanvasRenderingContext2D, camera: Camera, accent: string, paper: string): void {
    const path = new Path2D();
    const trace = (points: Point[], closed: boolean) => {
      points.forEach(([x, y], i) => {
        const at = camera.toScreen(x, y);
        if (i === 0) path.moveTo(...at);
        else path.lineTo(...at);
      });
      if (closed) path.closePath();
    };
    for (const ring of this.rings) trace(ring, true);
    on.fillStyle = accent;
    on.globalAlpha = 0.14;
    on.fill(path, "evenodd");
    on.globalAlpha = 1;
    trace(this.cursor && this.ring.length > 0 ? [...this.ring, this.cursor] : this.ring, false);
    on.strokeStyle = accent;
    on.lineWidth = 2;
    on.stroke(path);
    for (const points of [...this.rings, this.ring])
      points.forEach(([x, y], i) => {
        const [px, py] = camera.toScreen(x, y);
        on.beginPath();
        on.arc(px, py, points === this.ring && i === 0 ? 6 : 3.5, 0, 2 * Math.PI);
        on.fillStyle = paper;
        on.fill();
        on.stroke();
      });
    if (!this.cursor) return;
    const [px, py] = camera.toScreen(...this.cursor);
    on.lineWidth = 1;
    on.beginPath();
    on.moveTo(px - 9, py);
    on.lineTo(px + 9, py);
    on.moveTo(px, py - 9);
    on.lineTo(px, py + 9);
    on.stroke();
  }
}
