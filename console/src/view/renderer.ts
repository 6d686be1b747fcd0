// SPDX-License-Identifier: Apache-2.0
// Draws the chunks of a mesh with WebGL2, each with buffers of its own, and those alone that are on
// the screen. A chunk whose triangles are too small to be seen is drawn as its image.
import type { Camera } from "./camera";
import { chunkColour, lookUpTable, type ColourBy, type Rgb } from "./colours";
import type { Box, ChunkPicture } from "./picture";
import { thumbnailLevels, thumbnailSide } from "./thumbnail";

export interface Style {
  by: ColourBy;
  edges: boolean;
  range: [number, number]; // of the scale: degrees, logarithms of area to base 2, or ratios
  bounds: Float32Array; // logarithm of the bound on the area for each of 256 slots, for "ratio"
  plain: [number, number, number]; // 0 to 1
  ink: [number, number, number]; // of edges
  outline: [number, number, number]; // of the domain's segments
}

interface Chunk {
  index: number;
  triangles: number;
  box: Box;
  typicalArea: number;
  low: number;
  high: number;
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
const pageLayers = 256; // which every WebGL 2 has
const quadFloats = 10; // of each corner: position, place in the page, logArea, plain

// `own` declares logArea and plain, which are a chunk's.
const colour = (own: string) => `
precision highp float;
uniform int by;
uniform vec2 range;
${own}
uniform sampler2D table;
uniform sampler2D bounds;
vec3 look(float row, float t) {
  return texture(table, vec2((clamp(t, 0.0, 1.0) * 255.0 + 0.5) / 256.0, (row + 0.5) / 4.0)).rgb;
}

vec3 colourOf(float angle, float area, float slot) {
  float logarithm = mix(logArea.x, logArea.y, area);
  if (by == 0) return look(0.0, (angle * 60.0 - range.x) / (range.y - range.x));
  if (by == 1) return look(1.0, (logarithm - range.x) / max(range.y - range.x, 1e-6));
  if (by == 2) {
    float bound = texelFetch(bounds, ivec2(int(slot * 255.0 + 0.5), 0), 0).r;
    return look(2.0, (exp2(logarithm - bound) - range.x) / (range.y - range.x));
  }
  if (by == 3) return look(3.0, slot);
  return plain;
}`;

const ofChunk = "uniform vec2 logArea;\nuniform vec3 plain;";

const shaders = {
  triangles: [
    `#version 300 es
${colour(ofChunk)}
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 value;
uniform vec2 scale;
uniform vec2 offset;
flat out vec3 fill;
void main() {
  gl_Position = vec4(position * scale + offset, 0.0, 1.0);
  fill = colourOf(value.r, value.g, value.b);
}`,
    `#version 300 es
precision mediump float;
flat in vec3 fill;
out vec4 pixel;
void main() { pixel = vec4(fill, 1.0); }`,
  ],
  image: [
    `#version 300 es
uniform vec4 corners;
out vec2 at;
void main() {
  at = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  gl_Position = vec4(mix(corners.xy, corners.zw, at), 0.0, 1.0);
}`,
    `#version 300 es
${colour(ofChunk)}
uniform sampler2D image;
uniform sampler2D slots;
in vec2 at;
out vec4 pixel;
void main() {
  vec4 cell = texture(image, at);
  if (cell.a < 0.004) discard;
  float slot = by == 2 || by == 3 ? texture(slots, at).b : 0.0;
  pixel = vec4(colourOf(cell.r / cell.a, cell.g / cell.a, slot) * cell.a, cell.a);
}`,
  ],
  thumbnails: [
    `#version 300 es
layout(location = 0) in vec2 position;
layout(location = 1) in vec3 image;
layout(location = 2) in vec2 chunkLogArea;
layout(location = 3) in vec3 chunkPlain;
out vec3 at;
flat out vec2 logArea;
flat out vec3 plain;
void main() {
  at = image;
  logArea = chunkLogArea;
  plain = chunkPlain;
  gl_Position = vec4(position, 0.0, 1.0);
}`,
    `#version 300 es
${colour("flat in vec2 logArea;\nflat in vec3 plain;")}
precision highp sampler2DArray;
uniform sampler2DArray image;
uniform sampler2DArray slots;
in vec3 at;
out vec4 pixel;
void main() {
  vec4 cell = texture(image, at);
  if (cell.a < 0.004) discard;
  float slot = by == 2 || by == 3 ? texture(slots, at).b : 0.0;
  pixel = vec4(colourOf(cell.r / cell.a, cell.g / cell.a, slot) * cell.a, cell.a);
}`,
  ],
  lines: [
    `#version 300 es
layout(location = 0) in vec2 position;
layout(location = 1) in vec4 value;
uniform vec2 scale;
uniform vec2 offset;
uniform vec2 logArea;
uniform float logPixels; // per unit of area
uniform vec2 fade; // pixels from and to which a line becomes visible
uniform float least; // of its strength
out float strength;
void main() {
  gl_Position = vec4(position * scale + offset, 0.0, 1.0);
  float pixels = exp2(mix(logArea.x, logArea.y, value.g) + logPixels);
  strength = mix(least, 1.0, clamp((pixels - fade.x) / (fade.y - fade.x), 0.0, 1.0));
}`,
    `#version 300 es
precision mediump float;
uniform vec4 ink;
in float strength;
out vec4 pixel;
void main() { pixel = ink * strength; }`,
  ],
} as const;

type Uniforms = (name: string) => WebGLUniformLocation | null;

function plainOf({ index }: Chunk, style: Style): Rgb {
  return style.by === "chunk" ? (chunkColour(index).map((value) => value / 255) as Rgb) : style.plain;
}

export class Renderer {
  private readonly gl: WebGL2RenderingContext;
  private readonly chunks = new Map<number, Chunk>();
  private readonly programs: Record<keyof typeof shaders, { program: WebGLProgram; at: Uniforms }>;
  private readonly table: WebGLTexture;
  private readonly bounds: WebGLTexture;
  private readonly nearest: WebGLSampler;
  private readonly pages: WebGLTexture[] = [];
  private readonly quads: { vertices: WebGLVertexArrayObject; buffer: WebGLBuffer };
  private outline: { vertices: WebGLVertexArrayObject; buffer: WebGLBuffer; count: number; middle: [number, number] } | undefined;
  // Of the last frame.
  drawn = { triangles: 0, chunks: 0, images: 0 };

  // Undefined if the browser has no WebGL2. `wantLines` is called for chunks whose edges are to be
  // drawn; setLines() is the answer.
  static on(canvas: HTMLCanvasElement, wantLines: (chunk: number) => void): Renderer | undefined {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, powerPreference: "high-performance" });
    return gl ? new Renderer(gl, wantLines) : undefined;
  }

  private constructor(
    gl: WebGL2RenderingContext,
    private readonly wantLines: (chunk: number) => void,
  ) {
    this.gl = gl;
    const compiled = Object.entries(shaders).map(([name, [vertex, fragment]]) => [name, this.compile(vertex, fragment)]);
    this.programs = Object.fromEntries(compiled);
    const table = (): WebGLTexture => {
      const texture = gl.createTexture()!;
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
      return texture;
    };
    this.table = table();
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 4, 0, gl.RGBA, gl.UNSIGNED_BYTE, lookUpTable());
    this.bounds = table();
    this.nearest = gl.createSampler()!;
    gl.samplerParameteri(this.nearest, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.samplerParameteri(this.nearest, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    this.quads = this.makeQuads();
  }

  get size(): number {
    return this.chunks.size;
  }

  boxes(): IterableIterator<{ index: number; box: Box }> {
    return this.chunks.values();
  }

  add(picture: ChunkPicture): void {
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
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  draw(camera: Camera, ratio: number, style: Style): void {
    const { gl } = this;
    const width = Math.max(1, Math.round(camera.width * ratio));
    const height = Math.max(1, Math.round(camera.height * ratio));
    if (gl.canvas.width !== width) gl.canvas.width = width;
    if (gl.canvas.height !== height) gl.canvas.height = height;
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    this.drawn = { triangles: 0, chunks: 0, images: 0 };

    const seen = [...this.chunks.values()].filter((chunk) => camera.sees(chunk.box));
    const logPixels = 2 * Math.log2(camera.scale * ratio);
    const pixels = (chunk: Chunk) => chunk.typicalArea * 2 ** logPixels;
    const small = seen.filter((chunk) => pixels(chunk) < smallest);
    const large = seen.filter((chunk) => pixels(chunk) >= smallest);
    const tiny = (chunk: Chunk) =>
      Math.max(chunk.box[2] - chunk.box[0], chunk.box[3] - chunk.box[1]) * camera.scale * ratio < thumbnailTo;
    gl.enable(gl.BLEND);
    // Chunks share cells along their borders: each fills what the others have left.
    gl.blendFunc(gl.ONE_MINUS_DST_ALPHA, gl.ONE);
    this.drawThumbnails(small.filter(tiny), camera, style);
    this.drawImages(small.filter((chunk) => !tiny(chunk)), camera, style);
    gl.disable(gl.BLEND);
    this.drawTriangles(large, camera, style);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    if (style.edges)
      this.drawLines(large.filter((chunk) => 2 ** (chunk.high + logPixels) > edgesFrom), camera, style, logPixels);
    if (this.outline) this.drawOutline(camera, style);
    gl.bindVertexArray(null);
    this.drawn.chunks = seen.length;
    this.drawn.images = small.length;
  }

  private drawImages(chunks: Chunk[], camera: Camera, style: Style): void {
    const { gl } = this;
    const at = this.use("image", style);
    gl.uniform1i(at("image"), 2);
    gl.uniform1i(at("slots"), 3);
    gl.bindSampler(3, this.nearest);
    for (const chunk of chunks) {
      this.chunkUniforms(at, chunk, style);
      gl.activeTexture(gl.TEXTURE2);
      gl.bindTexture(gl.TEXTURE_2D, chunk.texture);
      gl.activeTexture(gl.TEXTURE3);
      gl.bindTexture(gl.TEXTURE_2D, chunk.texture);
      const [left, low] = this.toClip(camera, chunk.box[0], chunk.box[1]);
      const [right, high] = this.toClip(camera, chunk.box[2], chunk.box[3]);
      gl.uniform4f(at("corners"), left, low, right, high);
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
  }

  // A page at once, because there may be thousands. They are not instances: software renderers draw
  // each of those by itself.
  private drawThumbnails(chunks: Chunk[], camera: Camera, style: Style): void {
    if (chunks.length === 0) return;
    const { gl } = this;
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
          const position = this.toClip(camera, chunk.box[2 * right], chunk.box[2 * up + 1]);
          const own = [...position, right, up, chunk.layer, chunk.low, chunk.high, ...plain];
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

  private drawTriangles(chunks: Chunk[], camera: Camera, style: Style): void {
    const { gl } = this;
    const at = this.use("triangles", style);
    for (const chunk of chunks) {
      this.chunkUniforms(at, chunk, style);
      this.place(at, camera, (chunk.box[0] + chunk.box[2]) / 2, (chunk.box[1] + chunk.box[3]) / 2);
      gl.bindVertexArray(chunk.vertices);
      gl.drawElements(gl.TRIANGLES, chunk.count, chunk.type, 0);
      this.drawn.triangles += chunk.triangles;
    }
  }

  private drawLines(chunks: Chunk[], camera: Camera, style: Style, logPixels: number): void {
    const { gl } = this;
    const at = this.use("lines");
    gl.uniform2f(at("fade"), edgesFrom, edgesFull);
    gl.uniform1f(at("logPixels"), logPixels);
    for (const chunk of chunks) {
      if (chunk.lines === undefined) {
        chunk.lines = "wanted";
        this.wantLines(chunk.index);
      }
      if (chunk.lines === "wanted") continue;
      this.place(at, camera, (chunk.box[0] + chunk.box[2]) / 2, (chunk.box[1] + chunk.box[3]) / 2);
      const { vertices, inside, count } = chunk.lines;
      gl.bindVertexArray(vertices);
      gl.uniform2f(at("logArea"), chunk.low, chunk.high);
      this.inkOf(at, style.ink, 0.55);
      gl.uniform1f(at("least"), 0);
      gl.drawElements(gl.LINES, inside, gl.UNSIGNED_INT, 0);
      this.inkOf(at, style.ink, 1);
      gl.uniform1f(at("least"), 0.4);
      gl.drawElements(gl.LINES, count - inside, gl.UNSIGNED_INT, 4 * inside);
    }
  }

  private drawOutline(camera: Camera, style: Style): void {
    const { gl } = this;
    const { vertices, count, middle } = this.outline!;
    const at = this.use("lines");
    this.place(at, camera, ...middle);
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
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.bounds);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R32F, 256, 1, 0, gl.RED, gl.FLOAT, style.bounds);
    gl.uniform1i(at("table"), 0);
    gl.uniform1i(at("bounds"), 1);
    gl.uniform1i(at("by"), ["angle", "area", "ratio", "region"].indexOf(style.by));
    gl.uniform2f(at("range"), ...style.range);
    return at;
  }

  private chunkUniforms(at: Uniforms, chunk: Chunk, style: Style): void {
    const { gl } = this;
    gl.uniform2f(at("logArea"), chunk.low, chunk.high);
    gl.uniform3f(at("plain"), ...plainOf(chunk, style));
  }

  private place(at: Uniforms, camera: Camera, x: number, y: number): void {
    const { gl } = this;
    gl.uniform2f(at("scale"), (2 * camera.scale) / camera.width, (2 * camera.scale) / camera.height);
    gl.uniform2f(at("offset"), ...this.toClip(camera, x, y));
  }

  private toClip(camera: Camera, x: number, y: number): [number, number] {
    return [
      (2 * (x - camera.x) * camera.scale) / camera.width,
      (2 * (y - camera.y) * camera.scale) / camera.height,
    ];
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

  private compile(vertex: string, fragment: string): { program: WebGLProgram; at: Uniforms } {
    const { gl } = this;
    const program = gl.createProgram()!;
    for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
      const shader = gl.createShader(type)!;
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
      const logs = gl.getAttachedShaders(program)!.map((shader) => gl.getShaderInfoLog(shader));
      throw new Error(`a shader does not compile: ${logs.join("\n")}`);
    }
    const known = new Map<string, WebGLUniformLocation | null>();
    const at = (name: string) => {
      if (!known.has(name)) known.set(name, gl.getUniformLocation(program, name));
      return known.get(name)!;
    };
    return { program, at };
  }
}
