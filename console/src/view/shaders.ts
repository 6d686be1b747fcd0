// SPDX-License-Identifier: Apache-2.0
// The programs that draw a mesh: vertex and fragment shaders of WebGL 2.

// `own` declares shown and plain, which are a chunk's.
const colour = (own: string) => `
precision highp float;
uniform int by;
uniform vec2 range;
${own}
uniform sampler2D table;
vec3 look(float row, float t) {
  return texture(table, vec2((clamp(t, 0.0, 1.0) * 255.0 + 0.5) / 256.0, (row + 0.5) / 4.0)).rgb;
}

vec3 colourOf(float angle, float area, float slot) {
  float logarithm = mix(shown.x, shown.y, area);
  if (by == 0) return look(0.0, (angle * 60.0 - range.x) / (range.y - range.x));
  if (by == 1) return look(1.0, (logarithm - range.x) / max(range.y - range.x, 1e-6));
  if (by == 2) return look(2.0, (exp2(logarithm) - range.x) / (range.y - range.x));
  if (by == 3) return look(3.0, slot);
  return plain;
}`;

const ofChunk = "uniform vec2 shown;\nuniform vec3 plain;";

export const shaders = {
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
  float slot = by == 3 ? texture(slots, at).b : 0.0;
  pixel = vec4(colourOf(cell.r / cell.a, cell.g / cell.a, slot) * cell.a, cell.a);
}`,
  ],
  thumbnails: [
    `#version 300 es
layout(location = 0) in vec2 position;
layout(location = 1) in vec3 image;
layout(location = 2) in vec2 chunkShown;
layout(location = 3) in vec3 chunkPlain;
out vec3 at;
flat out vec2 shown;
flat out vec3 plain;
void main() {
  at = image;
  shown = chunkShown;
  plain = chunkPlain;
  gl_Position = vec4(position, 0.0, 1.0);
}`,
    `#version 300 es
${colour("flat in vec2 shown;\nflat in vec3 plain;")}
precision highp sampler2DArray;
uniform sampler2DArray image;
uniform sampler2DArray slots;
in vec3 at;
out vec4 pixel;
void main() {
  vec4 cell = texture(image, at);
  if (cell.a < 0.004) discard;
  float slot = by == 3 ? texture(slots, at).b : 0.0;
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
  float pixels = exp2(mix(logArea.x, logArea.y, value.a) + logPixels);
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

export type Uniforms = (name: string) => WebGLUniformLocation | null;

export interface Program {
  program: WebGLProgram;
  at: Uniforms;
}

// Throws if a shader does not compile.
export function compiled(gl: WebGL2RenderingContext, name: keyof typeof shaders): Program {
  const program = gl.createProgram()!;
  const [vertex, fragment] = shaders[name];
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
