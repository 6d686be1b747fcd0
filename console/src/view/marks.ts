// SPDX-License-Identifier: Apache-2.0
// What lies above the triangles: chunks that have just come, the quadtree, the worst triangles, the
// picked one, the sketch, and a bar that tells the scale.
import type { Camera } from "./camera";
import type { RunState } from "./mesh-run";
import type { Box } from "./picture";
import type { Sketch } from "./sketch";

interface Shown {
  quadtree: boolean;
  worst: boolean;
  dark: boolean;
  sketch: Sketch | undefined;
  backdrop: Backdrop | undefined;
}

// Drawn below all until the first chunks come.
export interface Backdrop {
  box: Box;
  image: CanvasImageSource;
  ends: Float64Array; // of the segments that it lies within, by parity
}

// Of a chunk that has just come.
export interface Flash {
  box: Box;
  strength: number; // 0 to 1
}

// Whether nothing is marked but the scale, which does not move with the picture.
export function isStill(shown: Shown, state: RunState, flashes: Flash[]): boolean {
  const overMesh = shown.quadtree || shown.worst || state.picked !== undefined || flashes.length > 0;
  return !overMesh && !shown.sketch && !(shown.backdrop && state.chunks === 0);
}

export function paintMarks(
  on: CanvasRenderingContext2D,
  camera: Camera,
  ratio: number,
  shown: Shown,
  state: RunState,
  flashes: Flash[],
): void {
  const width = Math.round(camera.width * ratio);
  const height = Math.round(camera.height * ratio);
  if (on.canvas.width !== width) on.canvas.width = width;
  if (on.canvas.height !== height) on.canvas.height = height;
  on.setTransform(ratio, 0, 0, ratio, 0, 0);
  on.clearRect(0, 0, camera.width, camera.height);
  const accent = shown.dark ? "#5cc4e4" : "#0b6a88";
  const paper = shown.dark ? "#0b0f13" : "#ffffff";
  const ink = shown.dark ? "#e4eaef" : "#17212b";

  if (shown.backdrop && state.chunks === 0) {
    const { box, image, ends } = shown.backdrop;
    on.save();
    on.clip(pathOf(camera, ends), "evenodd");
    on.globalAlpha = 0.85;
    on.drawImage(image, ...onScreen(camera, box));
    on.restore();
  }
  if (shown.sketch) paintGrid(on, camera, ink);
  for (const { box, strength } of flashes) {
    const [x, y, w, h] = onScreen(camera, box);
    on.globalAlpha = 0.5 * strength * strength;
    on.fillStyle = shown.dark ? "#ffffff" : "#ffd86b";
    on.fillRect(x, y, w, h);
    on.globalAlpha = strength;
    on.strokeStyle = accent;
    on.lineWidth = 1.5;
    on.strokeRect(x, y, w, h);
  }
  on.globalAlpha = 1;
  if (shown.quadtree) paintQuadtree(on, camera, state.summary?.leafBoxes ?? [], ink);
  if (shown.worst) {
    (state.census?.worst ?? []).forEach(({ x, y }, i) => paintNumber(on, camera.toScreen(x, y), i + 1));
  }
  if (state.picked) paintPicked(on, camera, state.picked.corners, paper);
  shown.sketch?.paint(on, camera, accent, paper);
  paintScale(on, camera, ink, paper);
}

function onScreen(camera: Camera, box: Box): [x: number, y: number, w: number, h: number] {
  const [left, top] = camera.toScreen(box[0], box[3]);
  return [left, top, (box[2] - box[0]) * camera.scale, (box[3] - box[1]) * camera.scale];
}

function pathOf(camera: Camera, ends: Float64Array): Path2D {
  const path = new Path2D();
  for (let i = 0; i < ends.length; i += 4) {
    if (i === 0 || ends[i] !== ends[i - 2] || ends[i + 1] !== ends[i - 1]) path.moveTo(...camera.toScreen(ends[i], ends[i + 1]));
    path.lineTo(...camera.toScreen(ends[i + 2], ends[i + 3]));
  }
  return path;
}

function paintQuadtree(on: CanvasRenderingContext2D, camera: Camera, boxes: number[], ink: string): void {
  on.beginPath();
  for (let i = 0; i < boxes.length; i += 4) {
    const box = boxes.slice(i, i + 4) as Box;
    if (camera.sees(box)) on.rect(...onScreen(camera, box));
  }
  on.strokeStyle = ink;
  on.globalAlpha = 0.7;
  on.lineWidth = 1;
  on.stroke();
  on.globalAlpha = 1;
}

function paintNumber(on: CanvasRenderingContext2D, [x, y]: [number, number], number: number): void {
  on.beginPath();
  on.arc(x, y, 9, 0, 2 * Math.PI);
  on.fillStyle = "#b3261e";
  on.fill();
  on.strokeStyle = "#ffffff";
  on.lineWidth = 1.5;
  on.stroke();
  on.fillStyle = "#ffffff";
  on.font = "600 11px system-ui, sans-serif";
  on.textAlign = "center";
  on.textBaseline = "middle";
  on.fillText(String(number), x, y + 0.5);
}

// A ring around it, too, if it is too small to be seen.
function paintPicked(on: CanvasRenderingContext2D, camera: Camera, corners: [number, number][], paper: string): void {
  const points = corners.map(([x, y]) => camera.toScreen(x, y));
  const spread = Math.max(...points.map(([x, y]) => Math.hypot(x - points[0][0], y - points[0][1])));
  on.beginPath();
  points.forEach((point, i) => (i === 0 ? on.moveTo(...point) : on.lineTo(...point)));
  on.closePath();
  if (spread < 14) {
    on.moveTo(points[0][0] + 14, points[0][1]);
    on.arc(...points[0], 14, 0, 2 * Math.PI);
  }
  on.lineJoin = "round";
  on.strokeStyle = paper;
  on.lineWidth = 5;
  on.stroke();
  on.strokeStyle = "#d6336c";
  on.lineWidth = 2.5;
  on.stroke();
}

// 1, 2 or 5 times a power of ten, the largest that is not above `most`.
export function roundLength(most: number): number {
  const power = 10 ** Math.floor(Math.log10(most));
  return (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1) * power;
}

function paintScale(on: CanvasRenderingContext2D, camera: Camera, ink: string, paper: string): void {
  const length = roundLength(130 / camera.scale);
  const right = camera.width - 16;
  const left = right - length * camera.scale;
  const y = camera.height - 16;
  for (const [colour, width] of [[paper, 5], [ink, 2]] as const) {
    on.beginPath();
    on.moveTo(left, y - 5);
    on.lineTo(left, y);
    on.lineTo(right, y);
    on.lineTo(right, y - 5);
    on.strokeStyle = colour;
    on.lineWidth = width;
    on.stroke();
  }
  on.font = "12px system-ui, sans-serif";
  on.textAlign = "center";
  on.textBaseline = "bottom";
  on.strokeStyle = paper;
  on.lineWidth = 4;
  const text = String(Number(length.toPrecision(1)));
  on.strokeText(text, (left + right) / 2, y - 5);
  on.fillStyle = ink;
  on.fillText(text, (left + right) / 2, y - 5);
}

function paintGrid(on: CanvasRenderingContext2D, camera: Camera, ink: string): void {
  const step = roundLength(60 / camera.scale);
  const [left, top] = camera.toPlane(0, 0);
  const [right, bottom] = camera.toPlane(camera.width, camera.height);
  on.beginPath();
  for (let i = Math.ceil(left / step); i * step < right; ++i) {
    const [x] = camera.toScreen(i * step, 0);
    on.moveTo(x, 0);
    on.lineTo(x, camera.height);
  }
  for (let i = Math.ceil(bottom / step); i * step < top; ++i) {
    const [, y] = camera.toScreen(0, i * step);
    on.moveTo(0, y);
    on.lineTo(camera.width, y);
  }
  on.strokeStyle = ink;
  on.globalAlpha = 0.12;
  on.lineWidth = 1;
  on.stroke();
  on.globalAlpha = 1;
}
