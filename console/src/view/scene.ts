// SPDX-License-Identifier: Apache-2.0
// The chunks of a mesh on the graphics card, each with buffers of its own, and how they are drawn: those
// alone that are in view, and as an image each if their triangles are too small to be seen.
import { chunkColour, lookUpTable, type ColourBy, type Rgb } from "./colours";
import type { Box, ChunkPicture } from "./picture";
import { compiled, shaders, type Program, type Uniforms } from "./shaders";
import { thumbnailLevels, thumbnailSide } from "./thumbnail";

export interface Style {
  by: ColourBy;
  edges: boolean;
  range: [number, number]; // of the scale: degrees, logarithms of area to base 2, or ratios
  plain: [number, number, number]; // 0 to 1
  ink: [number, number, number]; // of edges
  outline: [number, number, number]; // of the domain's segments
}

interface Chunk {
  index: number;
  triangles: number;
  box: Box;
  typicalArea: number;
  low: number; // logarithms of areas
  high: number;
  shown: [number, number]; // as in ChunkPicture
  vertices: WebGLVertexArrayObject;
  positions: WebGLBuffer;
  values: WebGLBuffer;
  count: number;
  type: number;
  texture: WebGLTexture;
  page: number; // of thumbnails
  layer: number; // in its page
  lines?: { vertices: WebGLVertexArrayObject; inside: number; count: number } | "wanted";
}

// Pixels that a triangle covers: below the first an image of the chunk is as good, from the second on
// its edges are drawn, faintly, from the third on fully.
const smallest = 2;
const edgesFrom = 12;
const edgesFull = 110;

// Pixels that a chunk's longer side takes: below, its thumbnail is as good as its image.
const thumbnailTo = 1.5 * thumbnailSide;
const pieceIndices = 3 << 13; // of triangles or edges, drawn at once
const pixelsPerTriangle = 64; // that cost as much as a triangle
const pageLayers = 256; // which every WebGL 2 has
const quadFloats = 10; // of each corner: position, place in the page, shown, plain

function plainOf({ index }: Chunk, style: Style): Rgb {
  return style.by === "chunk" ? (chunkColour(index).map((value) => value / 255) as Rgb) : style.plain;
}

// What of the plane is drawn: its middle, pixels per unit, and how many pixels.
export interface View {
  x: number;
  y: number;
  scale: number;
  width: number;
  height: number;
}

export const overlap = (a: Box, b: Box): boolean => a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3];

export class Scene {
  private readonly chunks = new Map<number, Chunk>();
  private readonly programs: Record<keyof typeof shaders, Program>;
  private readonly table: WebGLTexture;
  private readonly nearest: WebGLSampler;
  private readonly pages: WebGLTexture[] = [];
  private readonly quads: { vertices: WebGLVertexArrayObject; buffer: WebGLBuffer };
  private outline: { vertices: WebGLVertexArrayObject; buffer: WebGLBuffer; count: number; middle: [number, number] } | undefined;
  // `wantLines` is called for chunks whose edges are to be drawn; setLines() is the answer.
  constructor(
    private readonly gl: WebGL2RenderingContext,
    private readonly wantLines: (chunk: number) => void,
  ) {
    const names = Object.keys(shaders) as (keyof typeof shaders)[];
    this.programs = Object.fromEntries(names.map((name) => [name, compiled(gl, name)])) as typeof this.programs;
    const table = (): WebGLTexture => {
      const texture = gl.createTexture()!;
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
      return texture;
    };
    this.table = table();
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 4, 0, gl.RGBA, gl.UNSIGNED_BYTE, lookUpTable());
    this.nearest = gl.createSampler()!;
    gl.samplerParameteri(this.nearest, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.samplerParameteri(this.nearest, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    this.quads = this.makeQuads();
  }

  get size(): number {
    return this.chunks.size;
  }

  // Each chunk once.
  add(picture: ChunkPicture): void {
    if (this.chunks.has(picture.index)) return;
    const { gl } = this;
    const vertices = gl.createVertexArray()!;
    gl.bindVertexArray(vertices);
    const positions = this.buffer(gl.ARRAY_BUFFER, picture.positions);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
    const values = this.buffer(gl.ARRAY_BUFFER, picture.values);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, 0, 0);
    this.buffer(gl.ELEMENT_ARRAY_BUFFER, picture.indices);
    gl.bindVertexArray(null);

    const texture = gl.createTexture()!;
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(
      gl.TEXTURE_2D, 0, gl.RGBA8, picture.gridWidth, picture.gridHeight, 0, gl.RGBA, gl.UNSIGNED_BYTE, picture.grid,
    );
    gl.generateMipmap(gl.TEXTURE_2D);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);

    const number = this.chunks.size;
    const [page, layer] = [Math.floor(number / pageLayers), number % pageLayers];
    this.setThumbnail(page, layer, picture.thumbnail);
    this.chunks.set(picture.index, {
      index: picture.index,
      triangles: picture.triangles,
      box: picture.box,
      typicalArea: picture.typicalArea,
      low: picture.logAreaLow,
      high: picture.logAreaHigh,
      shown: [picture.shownLow, picture.shownHigh],
      vertices,
      positions,
      values,
      count: picture.indices.length,
      type: picture.indices instanceof Uint16Array ? gl.UNSIGNED_SHORT : gl.UNSIGNED_INT,
      texture,
      page,
      layer,
    });
  }

  setLines(index: number, lines: Uint32Array, inside: number): void {
    const { gl } = this;
    const chunk = this.chunks.get(index);
    if (!chunk) return;
    const vertices = gl.createVertexArray()!;
    gl.bindVertexArray(vertices);
    gl.bindBuffer(gl.ARRAY_BUFFER, chunk.positions);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
    gl.bindBuffer(gl.ARRAY_BUFFER, chunk.values);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 4, gl.UNSIGNED_BYTE, true, 0, 0);
    this.buffer(gl.ELEMENT_ARRAY_BUFFER, lines);
    gl.bindVertexArray(null);
    chunk.lines = { vertices, inside, count: lines.length };
  }

  // The segments of a domain, drawn until its mesh is there and above it; pairs of ends x, y.
  setOutline(ends: Float64Array, middle: [number, number]): void {
    const { gl } = this;
    if (this.outline) {
      gl.deleteVertexArray(this.outline.vertices);
      gl.deleteBuffer(this.outline.buffer);
    }
    const vertices = gl.createVertexArray()!;
    gl.bindVertexArray(vertices);
    const buffer = this.buffer(gl.ARRAY_BUFFER, Float32Array.from(ends, (value, i) => value - middle[i % 2]));
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
    gl.bindVertexArray(null);
    this.outline = { vertices, buffer, count: ends.length / 2, middle };
  }

  clear(): void {
    const { gl } = this;
    for (const chunk of this.chunks.values()) this.free(chunk);
    this.chunks.clear();
    for (const page of this.pages.splice(0)) gl.deleteTexture(page);
  }

  // Draws what lies in a part of the plane, piece by piece. Yields after each piece what it cost, in
  // triangles or as much; "filled" when edges alone are missing; "waiting" if setLines() has yet to
  // be called. The caller may draw anything else before the next piece.
  *paint(view: View, region: Box, style: Style): Generator<number | "filled" | "waiting", void> {
    const { gl } = this;
    const seen = [...this.chunks.values()].filter(({ box }) => overlap(box, region));
    const logPixels = 2 * Math.log2(view.scale);
    const isSmall = (chunk: Chunk) => chunk.typicalArea * 2 ** logPixels < smallest;
    const isTiny = ({ box }: Chunk) => Math.max(box[2] - box[0], box[3] - box[1]) * view.scale < thumbnailTo;
    const cost = ({ box }: Chunk) =>
      ((Math.min(box[2], region[2]) - Math.max(box[0], region[0])) *
        (Math.min(box[3], region[3]) - Math.max(box[1], region[1])) * view.scale ** 2) / pixelsPerTriangle;
    const large = seen.filter((chunk) => !isSmall(chunk));
    const withEdges = style.edges ? large.filter(({ high }) => 2 ** (high + logPixels) > edgesFrom) : [];
    for (const chunk of withEdges) this.askForLines(chunk);

    const thumbnails = seen.filter((chunk) => isSmall(chunk) && isTiny(chunk));
    this.drawThumbnails(thumbnails, view, style);
    yield thumbnails.reduce((sum, chunk) => sum + cost(chunk), 0);
    for (const chunk of seen) {
      if (!isSmall(chunk) || isTiny(chunk)) continue;
      this.drawImage(chunk, view, style);
      yield cost(chunk);
    }
    for (const chunk of large)
      for (let from = 0; from < chunk.count; from += pieceIndices) {
        const count = Math.min(pieceIndices, chunk.count - from);
        this.drawTriangles(chunk, from, count, view, style);
        yield count / 3 + (count / chunk.count) * cost(chunk);
      }
    yield "filled";
    for (const chunk of withEdges) {
      while (chunk.lines === "wanted") yield "waiting";
      if (typeof chunk.lines !== "object") continue;
      for (let from = 0; from < chunk.lines.count; from += pieceIndices) {
        const count = Math.min(pieceIndices, chunk.lines.count - from);
        this.drawLines(chunk, from, count, view, style, logPixels);
        yield count / 2;
      }
    }
    if (this.outline) this.drawOutline(view, style);
    gl.bindVertexArray(null);
  }

  // All chunks as small images of them, at once.
  paintThumbnails(view: View, style: Style): void {
    this.drawThumbnails([...this.chunks.values()], view, style);
    if (this.outline) this.drawOutline(view, style);
  }

  private askForLines(chunk: Chunk): void {
    if (chunk.lines !== undefined) return;
    chunk.lines = "wanted";
    this.wantLines(chunk.index);
  }

  private drawImage(chunk: Chunk, view: View, style: Style): void {
    const { gl } = this;
    this.fillWhatIsLeft();
    const at = this.use("image", style);
    gl.uniform1i(at("image"), 2);
    gl.uniform1i(at("slots"), 3);
    gl.bindSampler(3, this.nearest);
    this.chunkUniforms(at, chunk, style);
    for (const unit of [gl.TEXTURE2, gl.TEXTURE3]) {
      gl.activeTexture(unit);
      gl.bindTexture(gl.TEXTURE_2D, chunk.texture);
    }
    const [left, low] = this.toClip(view, chunk.box[0], chunk.box[1]);
    const [right, high] = this.toClip(view, chunk.box[2], chunk.box[3]);
    gl.uniform4f(at("corners"), left, low, right, high);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }

  // Chunks share cells along their borders: each fills what the others have left.
  private fillWhatIsLeft(): void {
    const { gl } = this;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE_MINUS_DST_ALPHA, gl.ONE);
  }

  // A page at once, because there may be thousands. They are not instances: software renderers draw
  // each of those by itself.
  private drawThumbnails(chunks: Chunk[], view: View, style: Style): void {
    if (chunks.length === 0) return;
    const { gl } = this;
    this.fillWhatIsLeft();
    const at = this.use("thumbnails", style);
    gl.uniform1i(at("image"), 4);
    gl.uniform1i(at("slots"), 5);
    gl.bindSampler(5, this.nearest);
    gl.bindVertexArray(this.quads.vertices);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.quads.buffer);
    for (const [page, texture] of this.pages.entries()) {
      const here = chunks.filter((chunk) => chunk.page === page);
      if (here.length === 0) continue;
      const values = new Float32Array(4 * quadFloats * here.length);
      here.forEach((chunk, i) => {
        const plain = plainOf(chunk, style);
        for (let corner = 0; corner < 4; ++corner) {
          const [right, up] = [corner & 1, corner >> 1];
          const position = this.toClip(view, chunk.box[2 * right], chunk.box[2 * up + 1]);
          const own = [...position, right, up, chunk.layer, ...chunk.shown, ...plain];
          values.set(own, quadFloats * (4 * i + corner));
        }
      });
      gl.bufferData(gl.ARRAY_BUFFER, values, gl.STREAM_DRAW);
      for (const unit of [gl.TEXTURE4, gl.TEXTURE5]) {
        gl.activeTexture(unit);
        gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
      }
      gl.drawElements(gl.TRIANGLES, 6 * here.length, gl.UNSIGNED_SHORT, 0);
    }
  }

  private makeQuads(): { vertices: WebGLVertexArrayObject; buffer: WebGLBuffer } {
    const { gl } = this;
    const vertices = gl.createVertexArray()!;
    const buffer = gl.createBuffer()!;
    gl.bindVertexArray(vertices);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    for (const [attribute, size, offset] of [[0, 2, 0], [1, 3, 2], [2, 2, 5], [3, 3, 7]]) {
      gl.enableVertexAttribArray(attribute);
      gl.vertexAttribPointer(attribute, size, gl.FLOAT, false, 4 * quadFloats, 4 * offset);
    }
    const corners = Array.from({ length: pageLayers }, (_, i) => [0, 1, 2, 2, 1, 3].map((corner) => 4 * i + corner));
    this.buffer(gl.ELEMENT_ARRAY_BUFFER, Uint16Array.from(corners.flat()));
    gl.bindVertexArray(null);
    return { vertices, buffer };
  }

  private setThumbnail(page: number, layer: number, levels: Uint8Array): void {
    const { gl } = this;
    if (page === this.pages.length) {
      const texture = gl.createTexture()!;
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
      gl.texStorage3D(gl.TEXTURE_2D_ARRAY, thumbnailLevels, gl.RGBA8, thumbnailSide, thumbnailSide, pageLayers);
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_NEAREST);
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
      this.pages.push(texture);
    }
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, this.pages[page]);
    let at = 0;
    for (let level = 0; level < thumbnailLevels; ++level) {
      const side = thumbnailSide >> level;
      const pixels = levels.subarray(at, (at += 4 * side * side));
      gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, level, 0, 0, layer, side, side, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    }
  }

  private drawTriangles(chunk: Chunk, from: number, count: number, view: View, style: Style): void {
    const { gl } = this;
    gl.disable(gl.BLEND);
    const at = this.use("triangles", style);
    this.chunkUniforms(at, chunk, style);
    this.place(at, view, (chunk.box[0] + chunk.box[2]) / 2, (chunk.box[1] + chunk.box[3]) / 2);
    gl.bindVertexArray(chunk.vertices);
    gl.drawElements(gl.TRIANGLES, count, chunk.type, from * (chunk.type === gl.UNSIGNED_SHORT ? 2 : 4));
  }

  // Those of the edges that are inside come first, and fade away where triangles are small.
  private drawLines(chunk: Chunk, from: number, count: number, view: View, style: Style, logPixels: number): void {
    if (typeof chunk.lines !== "object") return;
    const { gl } = this;
    const { vertices, inside } = chunk.lines;
    const at = this.use("lines");
    gl.uniform2f(at("fade"), edgesFrom, edgesFull);
    gl.uniform1f(at("logPixels"), logPixels);
    gl.uniform2f(at("logArea"), chunk.low, chunk.high);
    this.place(at, view, (chunk.box[0] + chunk.box[2]) / 2, (chunk.box[1] + chunk.box[3]) / 2);
    gl.bindVertexArray(vertices);
    const draw = (first: number, end: number, alpha: number, least: number) => {
      if (first >= end) return;
      this.inkOf(at, style.ink, alpha);
      gl.uniform1f(at("least"), least);
      gl.drawElements(gl.LINES, end - first, gl.UNSIGNED_INT, 4 * first);
    };
    this.lay();
    draw(from, Math.min(from + count, inside), 0.55, 0);
    draw(Math.max(from, inside), from + count, 1, 0.4);
  }

  // Above what is there.
  private lay(): void {
    const { gl } = this;
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  private drawOutline(view: View, style: Style): void {
    const { gl } = this;
    this.lay();
    const { vertices, count, middle } = this.outline!;
    const at = this.use("lines");
    this.place(at, view, ...middle);
    gl.uniform1f(at("least"), 1);
    this.inkOf(at, style.outline, this.chunks.size > 0 ? 0.45 : 0.9);
    gl.bindVertexArray(vertices);
    gl.drawArrays(gl.LINES, 0, count);
  }

  private inkOf(at: Uniforms, [red, green, blue]: [number, number, number], alpha: number): void {
    this.gl.uniform4f(at("ink"), red * alpha, green * alpha, blue * alpha, alpha);
  }

  private use(name: keyof typeof shaders, style?: Style): Uniforms {
    const { gl } = this;
    const { program, at } = this.programs[name];
    gl.useProgram(program);
    if (!style) return at;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.table);
    gl.uniform1i(at("table"), 0);
    gl.uniform1i(at("by"), ["angle", "area", "ratio", "region"].indexOf(style.by));
    gl.uniform2f(at("range"), ...style.range);
    return at;
  }

  private chunkUniforms(at: Uniforms, chunk: Chunk, style: Style): void {
    const { gl } = this;
    gl.uniform2f(at("shown"), ...chunk.shown);
    gl.uniform3f(at("plain"), ...plainOf(chunk, style));
  }

  private place(at: Uniforms, view: View, x: number, y: number): void {
    const { gl } = this;
    gl.uniform2f(at("scale"), (2 * view.scale) / view.width, (2 * view.scale) / view.height);
    gl.uniform2f(at("offset"), ...this.toClip(view, x, y));
  }

  private toClip({ x: middleX, y: middleY, scale, width, height }: View, x: number, y: number): [number, number] {
    return [(2 * (x - middleX) * scale) / width, (2 * (y - middleY) * scale) / height];
  }

  private buffer(target: number, values: Float32Array | Uint8Array | Uint16Array | Uint32Array): WebGLBuffer {
    const { gl } = this;
    const buffer = gl.createBuffer()!;
    gl.bindBuffer(target, buffer);
    gl.bufferData(target, values, gl.STATIC_DRAW);
    return buffer;
  }

  private free(chunk: Chunk): void {
    const { gl } = this;
    for (const vertices of [chunk.vertices, typeof chunk.lines === "object" ? chunk.lines.vertices : undefined]) {
      if (!vertices) continue;
      gl.bindVertexArray(vertices);
      gl.deleteBuffer(gl.getParameter(gl.ELEMENT_ARRAY_BUFFER_BINDING));
      for (const attribute of [0, 1])
        gl.deleteBuffer(gl.getVertexAttrib(attribute, gl.VERTEX_ATTRIB_ARRAY_BUFFER_BINDING));
      gl.bindVertexArray(null);
      gl.deleteVertexArray(vertices);
    }
    gl.deleteTexture(chunk.texture);
  }
}
