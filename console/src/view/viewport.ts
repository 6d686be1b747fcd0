// SPDX-License-Identifier: Apache-2.0
// The canvas of a mesh: draws what a run brings, and takes the mouse, the wheel, fingers and keys.
// Two canvases lie on each other: triangles below, drawn by the renderer, marks above.
import { Camera } from "./camera";
import type { ColourBy } from "./colours";
import type { MeshRun, RunPainter, RunState } from "./mesh-run";
import { isStill, paintMarks, type Backdrop, type Flash } from "./marks";
import type { Box, ChunkPicture } from "./picture";
import { Renderer } from "./renderer";
import type { Style } from "./scene";
import type { Sketch } from "./sketch";

export interface ViewSettings {
  by: ColourBy;
  range: [number, number]; // as in Style
  edges: boolean;
  quadtree: boolean;
  worst: boolean;
  dark: boolean;
  sketch: Sketch | undefined;
  backdrop: Backdrop | undefined;
}

const flightTime = 420; // milliseconds
const flashTime = 700;
const still = () => matchMedia("(prefers-reduced-motion: reduce)").matches;

interface Flight {
  from: { x: number; y: number; scale: number };
  to: { x: number; y: number; scale: number };
  start: number;
}

export class Viewport implements RunPainter {
  readonly camera = new Camera();
  private renderer: Renderer | undefined; // while the graphics card has what it was given
  private readonly marks: CanvasRenderingContext2D;
  private readonly stop = new AbortController();
  private readonly observer: ResizeObserver;
  private readonly flashes = new Map<number, { box: Box; start: number }>();
  private settings: ViewSettings | undefined;
  private home: Box | undefined; // of the domain, or of the mesh so far
  private segments: { ends: Float64Array; middle: [number, number] } = { ends: new Float64Array(), middle: [0, 0] };
  private outlined = false;
  private untouched = true; // the camera follows `home`
  private flight: Flight | undefined;
  private asked = false;
  private over = false; // whether the pictures show areas over their bounds, or areas alone
  private stillMarks = ""; // what the painted marks depend on; empty if on the place, too

  // Undefined if the browser has no WebGL2. `tellLost` is called when the browser takes the graphics
  // card away, and when it gives it back.
  static on(
    canvas: HTMLCanvasElement,
    marks: HTMLCanvasElement,
    run: MeshRun,
    tellLost: (lost: boolean) => void,
  ): Viewport | undefined {
    const renderer = Renderer.on(canvas, (chunk) => run.wantLines(chunk));
    return renderer && new Viewport(canvas, marks, run, tellLost, renderer);
  }

  private constructor(
    private readonly canvas: HTMLCanvasElement,
    marks: HTMLCanvasElement,
    private readonly run: MeshRun,
    private readonly tellLost: (lost: boolean) => void,
    renderer: Renderer,
  ) {
    this.renderer = renderer;
    this.marks = marks.getContext("2d")!;
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(canvas);
    this.listen();
    this.stop.signal.addEventListener("abort", run.attach(this));
    this.stop.signal.addEventListener("abort", run.listen(() => this.ask()));
  }

  close(): void {
    this.stop.abort();
    this.observer.disconnect();
    this.renderer?.clear();
  }

  set(settings: ViewSettings): void {
    this.settings = settings;
    this.wantPictures();
    this.ask();
  }

  // Has the pictures show what the settings want, if they do not.
  private wantPictures(): void {
    const over = this.settings!.by === "ratio";
    if (over === this.over) return;
    this.over = over;
    this.renderer?.clear();
    this.run.wantPictures(over);
  }

  // Segments drawn until the mesh is there, and above it; x, y of both ends of each.
  outline(ends: Float64Array, box: Box | undefined): void {
    this.outlined = box !== undefined;
    this.segments = { ends, middle: box ? [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2] : [0, 0] };
    this.renderer?.setOutline(ends, this.segments.middle);
    this.renderer?.clear();
    this.flashes.clear();
    this.home = box;
    this.untouched = true;
    this.fit();
  }

  fit(): void {
    this.untouched = true;
    if (!this.home) return;
    const to = new Camera();
    to.width = this.camera.width;
    to.height = this.camera.height;
    to.fit(this.home);
    this.fly(to);
  }

  zoom(factor: number): void {
    this.touch();
    this.camera.zoom(factor);
    this.ask();
  }

  // Moves to the triangle that the run has found.
  showPicked(): void {
    const { picked } = this.run.state;
    if (!picked) return;
    const [xs, ys] = [0, 1].map((d) => picked.corners.map((corner) => corner[d]));
    const size = Math.max(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys));
    this.untouched = false;
    const wanted = (0.16 * Math.min(this.camera.width, this.camera.height)) / (size || 1);
    this.fly({
      x: (xs[0] + xs[1] + xs[2]) / 3,
      y: (ys[0] + ys[1] + ys[2]) / 3,
      scale: Math.max(this.camera.scale, wanted),
    });
  }

  // --- what the run brings ---

  reset(): void {
    this.renderer?.clear();
    this.flashes.clear();
    this.over = false;
    if (this.settings) this.wantPictures();
    if (!this.outlined) this.home = undefined;
    this.ask();
  }

  chunk(picture: ChunkPicture): void {
    this.renderer?.add(picture);
    if (!still()) this.flashes.set(picture.index, { box: picture.box, start: performance.now() });
    const { box } = this.run.state;
    if (!this.outlined && box) {
      this.home = box;
      if (this.untouched) this.camera.fit(box);
    }
    this.ask();
  }

  again(picture: ChunkPicture): void {
    this.renderer?.add(picture);
    this.ask();
  }

  lines(chunk: number, lines: Uint32Array, inside: number): void {
    this.renderer?.setLines(chunk, lines, inside);
    this.ask();
  }

  // --- frames ---

  ask(): void {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame((now) => {
      this.asked = false;
      if (!this.stop.signal.aborted) this.frame(now);
    });
  }

  private frame(now: number): void {
    const { settings, camera, renderer } = this;
    if (!settings || !renderer || camera.width <= 1) return;
    this.advance(now);
    const ratio = devicePixelRatio;
    const { state } = this.run;
    const style = {
      by: settings.by,
      edges: settings.edges,
      range: settings.range,
      plain: settings.dark ? [0.15, 0.2, 0.24] : [0.9, 0.93, 0.95],
      ink: settings.by === "none" && settings.dark ? [0.75, 0.82, 0.87] : [0.05, 0.09, 0.12],
      outline: settings.dark ? [0.87, 0.91, 0.94] : [0.05, 0.09, 0.12],
    } satisfies Style;
    const progress = renderer.draw(camera, ratio, style, now);
    const drawn = progress === "whole" ? "whole" : "partly";
    if (this.canvas.dataset.drawn !== drawn) this.canvas.dataset.drawn = drawn;
    for (const [index, { start }] of this.flashes) if (now - start > flashTime) this.flashes.delete(index);
    const flashes = [...this.flashes.values()].map(({ box, start }) => ({
      box,
      strength: Math.min(1, Math.max(0, 1 - (now - start) / flashTime)),
    }));
    this.paintMarks(camera, ratio, settings, state, flashes);
    if (renderer.size > 0) this.run.painted();
    if (this.flashes.size > 0 || this.flight || progress === "drawing") this.ask();
  }

  // If nothing that moves with the picture is marked, painting them once is enough.
  private paintMarks(camera: Camera, ratio: number, settings: ViewSettings, state: RunState, flashes: Flash[]): void {
    const still = isStill(settings, state, flashes)
      ? [camera.scale, camera.width, camera.height, ratio, settings.dark].join()
      : "";
    if (still !== "" && still === this.stillMarks) return;
    this.stillMarks = still;
    paintMarks(this.marks, camera, ratio, settings, state, flashes);
  }

  private fly(to: { x: number; y: number; scale: number }): void {
    const { x, y, scale } = this.camera;
    this.flight = { from: { x, y, scale }, to: { x: to.x, y: to.y, scale: to.scale }, start: performance.now() };
    if (still() || !this.renderer?.size) this.flight.start = -Infinity;
    this.ask();
  }

  private advance(now: number): void {
    if (!this.flight) return;
    const { from, to, start } = this.flight;
    const t = Math.min(1, Math.max(0, (now - start) / flightTime));
    const s = t * t * (3 - 2 * t);
    this.camera.scale = from.scale * (to.scale / from.scale) ** s;
    // The way is covered in the pace of what is seen, so that the goal comes straight at the eye.
    const way = to.scale === from.scale ? s : (1 / this.camera.scale - 1 / from.scale) / (1 / to.scale - 1 / from.scale);
    this.camera.x = from.x + way * (to.x - from.x);
    this.camera.y = from.y + way * (to.y - from.y);
    if (t < 1) return;
    Object.assign(this.camera, to); // the sum above is rounded
    this.flight = undefined;
  }

  private resize(): void {
    this.camera.width = Math.max(1, this.canvas.clientWidth);
    this.camera.height = Math.max(1, this.canvas.clientHeight);
    if (this.untouched && this.home) {
      this.flight = undefined; // to a place for another size
      this.camera.fit(this.home);
    }
    this.ask();
  }

  // The graphics card is back, and has forgotten all.
  private restore(): void {
    this.renderer = Renderer.on(this.canvas, (chunk) => this.run.wantLines(chunk));
    if (!this.renderer) return;
    this.renderer.setOutline(this.segments.ends, this.segments.middle);
    this.run.wantPictures(this.over);
    this.tellLost(false);
    this.ask();
  }

  // --- input ---

  private touch(): void {
    this.untouched = false;
    this.flight = undefined;
  }

  private listen(): void {
    const { canvas, camera } = this;
    const options = { signal: this.stop.signal };
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault(); // otherwise it would not be given back
      this.renderer = undefined;
      this.tellLost(true);
    }, options);
    canvas.addEventListener("webglcontextrestored", () => this.restore(), options);
    const pointers = new Map<number, [number, number]>();
    let moved = 0;
    const place = (event: MouseEvent): [number, number] => {
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      if (pointers.size === 0) moved = 0;
      pointers.set(event.pointerId, place(event));
    }, options);
    canvas.addEventListener("pointermove", (event) => {
      const at = place(event);
      const before = pointers.get(event.pointerId);
      const sketch = this.settings?.sketch;
      if (sketch) {
        sketch.cursor = camera.toPlane(...at);
        this.ask();
      }
      if (!before) return;
      pointers.set(event.pointerId, at);
      moved += Math.hypot(at[0] - before[0], at[1] - before[1]);
      if (moved < 4) return;
      this.touch();
      const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
      if (other) {
        const distance = (point: [number, number]) => Math.hypot(point[0] - other[0], point[1] - other[1]) || 1;
        camera.zoom(distance(at) / distance(before), ...other);
      } else {
        camera.pan(at[0] - before[0], at[1] - before[1]);
      }
      this.ask();
    }, options);
    const lift = (event: PointerEvent) => {
      if (!pointers.delete(event.pointerId)) return;
      if (event.type === "pointerup" && event.button === 0 && moved < 4) this.press(camera.toPlane(...place(event)));
    };
    canvas.addEventListener("pointerup", lift, options);
    canvas.addEventListener("pointercancel", lift, options);
    canvas.addEventListener("pointerleave", () => {
      const sketch = this.settings?.sketch;
      if (sketch) sketch.cursor = undefined;
      this.ask();
    }, options);
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.touch();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : 1;
      const step = Math.max(-300, Math.min(300, event.deltaY * lines)) * (event.ctrlKey ? 0.01 : 0.0018);
      camera.zoom(Math.exp(-step), ...place(event));
      this.ask();
    }, { ...options, passive: false });
    canvas.addEventListener("dblclick", (event) => {
      if (this.settings?.sketch) return;
      this.touch();
      camera.zoom(2, ...place(event));
      this.ask();
    }, options);
    canvas.addEventListener("keydown", (event) => {
      if (this.key(event)) event.preventDefault();
    }, options);
  }

  private press(at: [number, number]): void {
    const sketch = this.settings?.sketch;
    if (sketch) sketch.set(at, this.camera.scale);
    else this.run.pick(...at);
    this.ask();
  }

  // Whether the key means something here.
  private key(event: KeyboardEvent): boolean {
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    const { camera } = this;
    const sketch = this.settings?.sketch;
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (way && sketch) {
      const step = event.shiftKey ? 40 : 10;
      const [x, y] = camera.toScreen(...(sketch.cursor ?? [camera.x, camera.y]));
      sketch.cursor = camera.toPlane(x + step * way[0], y + step * way[1]);
    } else if (way) {
      const step = event.shiftKey ? 240 : 60;
      this.touch();
      camera.pan(-step * way[0], -step * way[1]);
    } else {
      switch (event.key) {
        case "+":
        case "=":
          this.zoom(1.3);
          break;
        case "-":
          this.zoom(1 / 1.3);
          break;
        case "0":
          this.fit();
          break;
        case "Enter":
          this.press(sketch?.cursor ?? [camera.x, camera.y]);
          break;
        case "Backspace":
          if (!sketch) return false;
          sketch.undo();
          break;
        case "c":
          if (!sketch) return false;
          sketch.close();
          break;
        case "Escape":
          if (sketch || !this.run.state.picked) return false;
          this.run.unpick();
          break;
        default:
          return false;
      }
    }
    this.ask();
    return true;
  }
}
