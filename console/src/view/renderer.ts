// SPDX-License-Identifier: Apache-2.0
// Draws frames. What has been drawn is kept on a sheet larger than the screen, so that a picture that
// moves is the sheet at another place, and only what it lacks is drawn. If that takes longer than a
// frame may, it is done over several; until then small images of the chunks stand in for it.
import type { Camera } from "./camera";
import type { Box, ChunkPicture } from "./picture";
import { overlap, Scene, type Style, type View } from "./scene";

// "drawing": another frame will show more; "waiting": once setLines() was called, it will.
export type Progress = "whole" | "drawing" | "waiting";

interface Rect {
  left: number; // in pixels of a sheet or of the screen, from its lower left corner
  low: number;
  right: number;
  high: number;
}

interface Surface {
  texture: WebGLTexture;
  frame: WebGLFramebuffer;
}

interface Sheet {
  surface: Surface;
  x: number; // of its middle, in the plane
  y: number;
  scale: number; // pixels per unit
  style: string;
  revision: number; // of the scene
  drawn: Rect; // the rest is empty
}

// A part of a sheet that is being drawn, elsewhere.
interface Draft {
  sheet: Sheet;
  rect: Rect;
  pieces: ReturnType<Scene["paint"]>;
}

const margin = 0.25; // of the screen, around it on a sheet
const strip = 64; // pixels: what is drawn at once as a picture moves, or more
const samples = 4;
// Milliseconds between two frames: a frame may do more below the first, must do less above the second.
const pace = { moving: [25, 40], still: [60, 120] };
const [leastWork, mostWork] = [10_000, 4_000_000]; // per frame, in triangles
const mostEnlarged = 16; // a sheet drawn at another scale

const isEmpty = ({ left, low, right, high }: Rect): boolean => left >= right || low >= high;

const common = (a: Rect, b: Rect): Rect => ({
  left: Math.max(a.left, b.left),
  low: Math.max(a.low, b.low),
  right: Math.min(a.right, b.right),
  high: Math.min(a.high, b.high),
});

const shifted = ({ left, low, right, high }: Rect, dx: number, dy: number): Rect => ({
  left: left + dx,
  low: low + dy,
  right: right + dx,
  high: high + dy,
});

const nameOf = (style: Style): string => JSON.stringify(style);

export class Renderer {
  private readonly scene: Scene;
  private readonly surfaces: [Surface, Surface];
  private readonly resolved: Surface;
  private readonly rough: WebGLFramebuffer; // for drafts, with several samples per pixel
  private readonly roughBuffer: WebGLRenderbuffer;
  private screen = { width: 0, height: 0 }; // pixels
  private border = { x: 0, y: 0 }; // of a sheet around the screen, in pixels
  private revision = 0;
  private sheet: Sheet | undefined; // that is shown
  private draft: Draft | undefined;
  private work = 200_000; // that a frame may do, in triangles
  private last = { time: 0, busy: false, x: 0, y: 0, scale: 0 };

  // Undefined if the browser has no WebGL2. `wantLines` is called for chunks whose edges are to be
  // drawn; setLines() is the answer.
  static on(canvas: HTMLCanvasElement, wantLines: (chunk: number) => void): Renderer | undefined {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: true, powerPreference: "high-performance" });
    return gl ? new Renderer(gl, wantLines) : undefined;
  }

  private constructor(
    private readonly gl: WebGL2RenderingContext,
    wantLines: (chunk: number) => void,
  ) {
    this.scene = new Scene(gl, wantLines);
    this.surfaces = [this.surface(), this.surface()];
    this.resolved = this.surface();
    this.roughBuffer = gl.createRenderbuffer()!;
    this.rough = gl.createFramebuffer()!;
    gl.bindRenderbuffer(gl.RENDERBUFFER, this.roughBuffer);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.rough);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.RENDERBUFFER, this.roughBuffer);
  }

  get size(): number {
    return this.scene.size;
  }

  add(picture: ChunkPicture): void {
    this.scene.add(picture);
    const sheets = [this.sheet, this.draft?.sheet];
    if (sheets.some((sheet) => sheet && overlap(this.regionOf(sheet, this.whole()), picture.box))) ++this.revision;
  }

  setLines(index: number, lines: Uint32Array, inside: number): void {
    this.scene.setLines(index, lines, inside);
  }

  // The segments of a domain, drawn until its mesh is there and above it; pairs of ends x, y.
  setOutline(ends: Float64Array, middle: [number, number]): void {
    this.scene.setOutline(ends, middle);
    this.forget();
  }

  clear(): void {
    this.scene.clear();
    this.forget();
  }

  // Draws a frame; `now` is performance.now().
  draw(camera: Camera, ratio: number, style: Style, now: number): Progress {
    this.resize(Math.max(1, Math.round(camera.width * ratio)), Math.max(1, Math.round(camera.height * ratio)));
    const view = { x: camera.x, y: camera.y, scale: camera.scale * ratio, ...this.screen };
    this.keepPace(view, now);
    const progress = this.drawOnSheet(view, style);
    this.show(view, style);
    this.last = { time: now, busy: progress === "drawing", x: view.x, y: view.y, scale: view.scale };
    return progress;
  }

  private forget(): void {
    this.sheet = this.draft = undefined;
    ++this.revision;
  }

  private resize(width: number, height: number): void {
    if (this.screen.width === width && this.screen.height === height) return;
    const { gl } = this;
    this.screen = { width, height };
    this.border = { x: Math.ceil(margin * width), y: Math.ceil(margin * height) };
    this.forget();
    gl.canvas.width = width;
    gl.canvas.height = height;
    const { right, high } = this.whole();
    for (const { texture } of [...this.surfaces, this.resolved]) {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, right, high, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
    }
    gl.bindRenderbuffer(gl.RENDERBUFFER, this.roughBuffer);
    const most = Math.min(samples, gl.getParameter(gl.MAX_SAMPLES) ?? 0);
    gl.renderbufferStorageMultisample(gl.RENDERBUFFER, most, gl.RGBA8, right, high);
  }

  private surface(): Surface {
    const { gl } = this;
    const texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    const frame = gl.createFramebuffer()!;
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    return { texture, frame };
  }

  private keepPace(view: View, now: number): void {
    const { time, busy, x, y, scale } = this.last;
    if (!busy) return;
    const [quick, slow] = x === view.x && y === view.y && scale === view.scale ? pace.still : pace.moving;
    if (now - time > slow) this.work = Math.max(leastWork, 0.6 * this.work);
    if (now - time < quick) this.work = Math.min(mostWork, 1.5 * this.work);
  }

  // Of a sheet.
  private whole(): Rect {
    return {
      left: 0,
      low: 0,
      right: this.screen.width + 2 * this.border.x,
      high: this.screen.height + 2 * this.border.y,
    };
  }

  // Of the plane.
  private regionOf({ x, y, scale }: Sheet, { left, low, right, high }: Rect): Box {
    const { right: width, high: height } = this.whole();
    return [
      x + (left - width / 2) / scale,
      y + (low - height / 2) / scale,
      x + (right - width / 2) / scale,
      y + (high - height / 2) / scale,
    ];
  }

  // The screen, in the pixels of a sheet of the same scale.
  private screenOn(sheet: Sheet, { x, y, scale }: View): Rect {
    const left = this.border.x + Math.round((x - sheet.x) * scale);
    const low = this.border.y + Math.round((y - sheet.y) * scale);
    return { left, low, right: left + this.screen.width, high: low + this.screen.height };
  }

  private drawOnSheet(view: View, style: Style): Progress {
    const name = nameOf(style);
    const { draft } = this;
    const zoomed = draft ? draft.sheet.scale / view.scale : 1;
    // A draft that is only a little old is finished: while a picture is zoomed there may be no other.
    if (draft && (draft.sheet.style !== name || zoomed > 2 || zoomed < 0.5)) this.draft = undefined;
    let left = this.work;
    for (;;) {
      this.draft ??= this.begin(view, name, style);
      if (!this.draft) return "whole";
      if (left <= 0) return "drawing";
      const piece = this.paint(this.draft);
      if (piece === "waiting") return "waiting";
      left -= piece;
    }
  }

  // What the screen lacks, or else what the sheet does.
  private begin(view: View, name: string, style: Style): Draft | undefined {
    const { sheet } = this;
    if (!sheet || sheet.style !== name || sheet.revision !== this.revision || sheet.scale !== view.scale)
      return this.beginSheet(view, name, style);
    if (isEmpty(common(this.screenOn(sheet, view), sheet.drawn))) return this.beginSheet(view, name, style);
    const whole = this.whole();
    const wanted = this.screenOn(sheet, view);
    if (isEmpty(wanted) || wanted.left < 0 || wanted.low < 0 || wanted.right > whole.right || wanted.high > whole.high)
      this.moveSheet(sheet, wanted);
    const rect = this.nextStrip(sheet.drawn, this.screenOn(sheet, view));
    return rect && this.start(sheet, rect, style);
  }

  private beginSheet(view: View, name: string, style: Style): Draft {
    const surface = this.surfaces[this.sheet?.surface === this.surfaces[0] ? 1 : 0];
    const { x, y, scale } = view;
    const drawn = { left: 0, low: 0, right: 0, high: 0 };
    const sheet = { surface, x, y, scale, style: name, revision: this.revision, drawn };
    return this.start(sheet, this.screenOn(sheet, view), style);
  }

  private start(sheet: Sheet, rect: Rect, style: Style): Draft {
    const { gl } = this;
    const { right: width, high: height } = this.whole();
    const view = { x: sheet.x, y: sheet.y, scale: sheet.scale, width, height };
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.rough);
    this.restrictTo(rect);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    return { sheet, rect, pieces: this.scene.paint(view, this.regionOf(sheet, rect), style) };
  }

  // The side on which the screen lacks most, or, if it lacks nothing, one on which there is room.
  private nextStrip(drawn: Rect, screen: Rect): Rect | undefined {
    const whole = this.whole();
    const sides = [
      { lack: drawn.left - screen.left, room: drawn.left, of: (n: number) => ({ ...drawn, left: drawn.left - n, right: drawn.left }) },
      { lack: screen.right - drawn.right, room: whole.right - drawn.right, of: (n: number) => ({ ...drawn, left: drawn.right, right: drawn.right + n }) },
      { lack: drawn.low - screen.low, room: drawn.low, of: (n: number) => ({ ...drawn, low: drawn.low - n, high: drawn.low }) },
      { lack: screen.high - drawn.high, room: whole.high - drawn.high, of: (n: number) => ({ ...drawn, low: drawn.high, high: drawn.high + n }) },
    ].filter(({ room }) => room > 0);
    const [most] = sides.sort((a, b) => b.lack - a.lack);
    return most?.of(Math.min(most.room, Math.max(most.lack, strip)));
  }

  // Puts what is on the screen, at `place`, into the middle.
  private moveSheet(sheet: Sheet, place: Rect): void {
    const [dx, dy] = [place.left - this.border.x, place.low - this.border.y];
    const drawn = common(shifted(sheet.drawn, -dx, -dy), this.whole());
    const from = shifted(drawn, dx, dy);
    const surface = this.surfaces[sheet.surface === this.surfaces[0] ? 1 : 0];
    this.copy(sheet.surface, from, surface, drawn);
    Object.assign(sheet, { surface, drawn, x: sheet.x + dx / sheet.scale, y: sheet.y + dy / sheet.scale });
  }

  // One piece of a draft; returns its cost.
  private paint(draft: Draft): number | "waiting" {
    const { gl } = this;
    const { right, high } = this.whole();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.rough);
    gl.viewport(0, 0, right, high);
    this.restrictTo(draft.rect);
    const { value, done } = draft.pieces.next();
    const isNew = draft.sheet !== this.sheet;
    if (typeof value !== "string" && !done) return value!;
    if (value === "waiting") return value;
    // A new sheet is shown without its edges already; a strip waits for them.
    if (!done && !isNew) return 0;
    this.finish(draft);
    if (done) this.draft = undefined;
    return 0;
  }

  // Not resolved onto the sheet itself: SwiftShader resolves more than the rectangle.
  private finish({ sheet, rect }: Draft): void {
    this.stretch(this.rough, rect, this.resolved.frame, rect, this.gl.NEAREST);
    this.copy(this.resolved, rect, sheet.surface, rect);
    const { drawn } = sheet;
    sheet.drawn = isEmpty(drawn)
      ? rect
      : {
          left: Math.min(drawn.left, rect.left),
          low: Math.min(drawn.low, rect.low),
          right: Math.max(drawn.right, rect.right),
          high: Math.max(drawn.high, rect.high),
        };
    this.sheet = sheet;
  }

  private show(view: View, style: Style): void {
    const { gl } = this;
    const screen = { left: 0, low: 0, right: this.screen.width, high: this.screen.height };
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    this.restrictTo(screen);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    const { sheet } = this;
    const enlarged = sheet ? view.scale / sheet.scale : 0;
    const usable = sheet && enlarged < mostEnlarged && enlarged > 1 / mostEnlarged;
    const place = usable ? this.placeOf(sheet, view) : { left: 0, low: 0, right: 0, high: 0 };
    const shown = common(place, screen);
    const around = isEmpty(shown)
      ? [screen]
      : [
          { ...screen, right: shown.left },
          { ...screen, left: shown.right },
          { ...shown, low: 0, high: shown.low },
          { ...shown, low: shown.high, high: screen.high },
        ].filter((rect) => !isEmpty(rect));
    gl.viewport(0, 0, screen.right, screen.high);
    for (const rect of around) {
      this.restrictTo(rect);
      this.scene.paintThumbnails(view, style);
    }
    if (!usable || isEmpty(shown)) return;
    this.restrictTo(screen);
    if (enlarged !== 1) return this.stretch(sheet.surface.frame, sheet.drawn, null, place, gl.LINEAR);
    const source = shifted(shown, sheet.drawn.left - place.left, sheet.drawn.low - place.low);
    this.stretch(sheet.surface.frame, source, null, shown, gl.NEAREST);
  }

  // On the screen.
  private placeOf(sheet: Sheet, view: View): Rect {
    if (view.scale === sheet.scale) {
      const { left, low } = this.screenOn(sheet, view);
      return shifted(sheet.drawn, -left, -low);
    }
    const [left, low, right, high] = this.regionOf(sheet, sheet.drawn);
    const x = (at: number) => Math.round((at - view.x) * view.scale + this.screen.width / 2);
    const y = (at: number) => Math.round((at - view.y) * view.scale + this.screen.height / 2);
    return { left: x(left), low: y(low), right: x(right), high: y(high) };
  }

  private restrictTo({ left, low, right, high }: Rect): void {
    const { gl } = this;
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(left, low, Math.max(0, right - left), Math.max(0, high - low));
  }

  // Rectangles of one size.
  private copy(from: Surface, { left, low, right, high }: Rect, to: Surface, target: Rect): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, from.frame);
    gl.bindTexture(gl.TEXTURE_2D, to.texture);
    gl.copyTexSubImage2D(gl.TEXTURE_2D, 0, target.left, target.low, left, low, right - left, high - low);
  }

  private stretch(from: WebGLFramebuffer, source: Rect, to: WebGLFramebuffer | null, target: Rect, filter: number): void {
    const { gl } = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, from);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, to);
    if (to) gl.disable(gl.SCISSOR_TEST);
    gl.blitFramebuffer(
      source.left, source.low, source.right, source.high, target.left, target.low, target.right, target.high,
      gl.COLOR_BUFFER_BIT, filter,
    );
  }
}
