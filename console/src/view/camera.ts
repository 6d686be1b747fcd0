// SPDX-License-Identifier: Apache-2.0
// Which part of the plane is on the screen. y goes up in the plane, down on the screen.
import type { Box } from "./picture";

const room = 0.94; // of the screen, for what is to be seen
const legend = 64; // pixels at the bottom of the screen

export class Camera {
  x = 0; // of the middle of the screen
  y = 0;
  scale = 1; // pixels per unit
  width = 1; // of the screen, in pixels
  height = 1;

  // Shows all of a box, above the legend.
  fit(box: Box): void {
    const width = box[2] - box[0];
    const height = box[3] - box[1];
    const high = Math.max(this.height - legend, this.height / 2);
    this.scale = Math.min((room * this.width) / (width || height || 1), (room * high) / (height || width || 1));
    this.x = box[0] + width / 2;
    this.y = box[1] + height / 2 - (this.height - high) / 2 / this.scale;
  }

  // By pixels; what was at (0, 0) is then at (dx, dy).
  pan(dx: number, dy: number): void {
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }

  // The point under the pixel stays there.
  zoom(factor: number, px = this.width / 2, py = this.height / 2): void {
    const [x, y] = this.toPlane(px, py);
    this.scale = Math.min(Math.max(this.scale * factor, 1e-60), 1e60);
    const [nowX, nowY] = this.toPlane(px, py);
    this.x += x - nowX;
    this.y += y - nowY;
  }

  toPlane(px: number, py: number): [number, number] {
    return [this.x + (px - this.width / 2) / this.scale, this.y - (py - this.height / 2) / this.scale];
  }

  toScreen(x: number, y: number): [number, number] {
    return [this.width / 2 + (x - this.x) * this.scale, this.height / 2 - (y - this.y) * this.scale];
  }

  sees(box: Box): boolean {
    const w = this.width / 2 / this.scale;
    const h = this.height / 2 / this.scale;
    return box[2] >= this.x - w && box[0] <= this.x + w && box[3] >= this.y - h && box[1] <= this.y + h;
  }
}
