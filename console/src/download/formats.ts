// SPDX-License-Identifier: Apache-2.0
// Files of meshes, written from the chunks as they come. The formats and their names for regions and
// markers are those of `weft` (docs/formats.md), so that a file from here is as good as one from there.
//
//   const writer = formats.vtu.begin(names);
//   for (const chunk of chunks) writer.add(chunk);
//   const file = await writer.finish();
import type { MeshNames, Names } from "../domain/names";
import { Section } from "./sections";
import { gmshName, inXml, objGroup, spelled } from "./spelling";

// The arrays of a weft.v1.Chunk that files need. An empty `regions` or `edgeMarkers` means zeros.
export interface MeshPiece {
  coordinates: ArrayLike<number>;
  triangles: ArrayLike<number>;
  regions: ArrayLike<number>;
  edges: ArrayLike<number>;
  edgeMarkers: ArrayLike<number>;
}

export interface MeshWriter {
  add(piece: MeshPiece): void;
  // Call once, last.
  finish(): Blob | Promise<Blob>;
}

const int32s = (given: ArrayLike<number>, count: number): Int32Array<ArrayBuffer> =>
  given.length > 0 ? Int32Array.from(given) : new Int32Array(count);

// `count` integers of 64 bits, little-endian.
function int64s(count: number, value: (i: number) => number): Uint32Array<ArrayBuffer> {
  const halves = new Uint32Array(2 * count);
  for (let i = 0; i < count; ++i) {
    const number = value(i);
    halves[2 * i] = number % 2 ** 32;
    halves[2 * i + 1] = number / 2 ** 32;
  }
  return halves;
}

const u64 = (...numbers: number[]) => int64s(numbers.length, (i) => numbers[i]!);
const i32 = (...numbers: number[]) => Int32Array.from(numbers);

// Calls `put` with the first of each piece of `count` and its length: what is made at a time is small.
function inBlocks(count: number, put: (first: number, length: number) => void): void {
  const most = 1 << 14;
  for (let first = 0; first < count; first += most) put(first, Math.min(most, count - first));
}

// x, y, 0 of each vertex.
function inSpace(coordinates: ArrayLike<number>): Float64Array<ArrayBuffer> {
  const out = new Float64Array((coordinates.length / 2) * 3);
  for (let v = 0; 2 * v < coordinates.length; ++v) {
    out[3 * v] = coordinates[2 * v]!;
    out[3 * v + 1] = coordinates[2 * v + 1]!;
  }
  return out;
}

// An array for each name: the number, and the dimension of what has it.
function fieldData({ markers, regions }: MeshNames): string {
  const rows = [[markers, 1], [regions, 2]].flatMap(([names, dimension]) =>
    [...(names as Names)].sort(([a], [b]) => a - b).map(([id, name]) =>
      `<DataArray type="Int32" Name="${inXml(name)}" NumberOfTuples="2" format="ascii">${id} ${dimension}</DataArray>\n`));
  return rows.length > 0 ? `<FieldData>\n${rows.join("")}</FieldData>\n` : "";
}

class Vtu implements MeshWriter {
  private points = new Section();
  private corners = new Section();
  private regions = new Section();
  private edges = new Section();
  private markers = new Section();

  constructor(private readonly names: MeshNames) {}

  add(piece: MeshPiece): void {
    this.points.put(inSpace(piece.coordinates));
    this.corners.put(Uint32Array.from(piece.triangles));
    this.regions.put(int32s(piece.regions, piece.triangles.length / 3));
    this.edges.put(Uint32Array.from(piece.edges));
    this.markers.put(int32s(piece.edgeMarkers, piece.edges.length / 2));
  }

  finish(): Blob {
    const triangles = this.corners.size / 12;
    const edges = this.edges.size / 8;
    const ends = new Section();
    const types = new Section();
    const noRegions = new Section(); // of the edges
    const noMarkers = new Section(); // of the triangles
    inBlocks(triangles, (first, length) => {
      ends.put(int64s(length, (i) => 3 * (first + i + 1)));
      types.put(new Uint8Array(length).fill(5));
      noMarkers.put(new Int32Array(length));
    });
    inBlocks(edges, (first, length) => {
      ends.put(int64s(length, (i) => 3 * triangles + 2 * (first + i + 1)));
      types.put(new Uint8Array(length).fill(3));
      noRegions.put(new Int32Array(length));
    });
    const arrays: [string, Section[]][] = [
      ['<Points><DataArray type="Float64" Name="Points" NumberOfComponents="3"', [this.points]],
      ['</Points><Cells><DataArray type="UInt32" Name="connectivity"', [this.corners, this.edges]],
      ['<DataArray type="Int64" Name="offsets"', [ends]],
      ['<DataArray type="UInt8" Name="types"', [types]],
      ['</Cells><CellData><DataArray type="Int32" Name="region"', [this.regions, noRegions]],
      ['<DataArray type="Int32" Name="marker"', [noMarkers, this.markers]],
    ];
    let head =
      '<?xml version="1.0"?>\n<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" ' +
      `header_type="UInt64">\n<UnstructuredGrid>${fieldData(this.names)}<Piece NumberOfPoints="${this.points.size / 24}" ` +
      `NumberOfCells="${triangles + edges}">\n`;
    let offset = 0;
    const body: BlobPart[] = [];
    for (const [tag, sections] of arrays) {
      const bytes = sections.reduce((sum, section) => sum + section.size, 0);
      head += `${tag} format="appended" offset="${offset}"/>\n`;
      offset += 8 + bytes;
      body.push(u64(bytes), ...sections.flatMap((section) => section.blobs()));
    }
    head += '</CellData></Piece></UnstructuredGrid>\n<AppendedData encoding="raw">\n_';
    return new Blob([head, ...body, "\n</AppendedData>\n</VTKFile>\n"]);
  }
}

// Elements by their region or marker.
class Groups {
  private readonly sections = new Map<number, Section>();

  // `word`: what they are, and are called if they have no name.
  constructor(private readonly word: string, private readonly names: Names) {}

  of(value: number): Section {
    const known = this.sections.get(value);
    if (known) return known;
    const section = new Section();
    this.sections.set(value, section);
    return section;
  }

  // Ascending, each with Gmsh's tag: the value itself if that is positive, else the lowest free.
  sorted(): { value: number; tag: number; section: Section }[] {
    let free = 0;
    return [...this.sections]
      .sort(([a], [b]) => a - b)
      .map(([value, section]) => {
        if (value > 0) return { value, tag: value, section };
        do ++free;
        while (this.sections.has(free) || this.names.has(free));
        return { value, tag: free, section };
      });
  }

  // The lines of $PhysicalNames. A positive number that has a name, but no element, is there, too.
  physicalNames(dimension: number): string[] {
    const names = spelled(this.names, gmshName);
    return [
      ...this.sorted().map(({ value, tag }) => [tag, names.get(value) ?? `${this.word} ${value}`]),
      ...[...names].filter(([id]) => id > 0 && !this.sections.has(id)),
    ].map(([tag, name]) => `${dimension} ${tag} "${name}"\n`);
  }
}

class Msh implements MeshWriter {
  private readonly points = new Section();
  private readonly surfaces: Groups;
  private readonly curves: Groups;
  private readonly low = [Infinity, Infinity, 0];
  private readonly high = [-Infinity, -Infinity, 0];
  private elements = 0;

  constructor({ markers, regions }: MeshNames) {
    this.surfaces = new Groups("region", regions);
    this.curves = new Groups("marker", markers);
  }

  add(piece: MeshPiece): void {
    this.points.put(inSpace(piece.coordinates));
    for (let i = 0; i < piece.coordinates.length; ++i) {
      this.low[i % 2] = Math.min(this.low[i % 2]!, piece.coordinates[i]!);
      this.high[i % 2] = Math.max(this.high[i % 2]!, piece.coordinates[i]!);
    }
    this.put(this.surfaces, piece.triangles, piece.regions, 3);
    this.put(this.curves, piece.edges, piece.edgeMarkers, 2);
  }

  // An element is its number and its nodes, from 1.
  private put(groups: Groups, nodes: ArrayLike<number>, of: ArrayLike<number>, each: number): void {
    const valueOf = (i: number) => (of.length > 0 ? of[i]! : 0);
    const count = nodes.length / each;
    const width = each + 1;
    for (let first = 0, end; first < count; first = end) {
      for (end = first + 1; end < count && valueOf(end) === valueOf(first); ) ++end;
      groups.of(valueOf(first)).put(
        int64s(width * (end - first), (i) => {
          const element = first + Math.floor(i / width);
          return i % width === 0 ? ++this.elements : nodes[each * element + (i % width) - 1]! + 1;
        }),
      );
    }
  }

  finish(): Blob {
    const vertices = this.points.size / 24;
    const curves = this.curves.sorted();
    const surfaces = this.surfaces.sorted();
    const names = [...this.curves.physicalNames(1), ...this.surfaces.physicalNames(2)];
    const parts: BlobPart[] = ["$MeshFormat\n4.1 1 8\n", i32(1), "\n$EndMeshFormat\n"];
    parts.push(`$PhysicalNames\n${names.length}\n${names.join("")}$EndPhysicalNames\n`);
    parts.push("$Entities\n", u64(0, curves.length, surfaces.length, 0));
    const box = Float64Array.from([...this.low, ...this.high]);
    for (const groups of [curves, surfaces])
      groups.forEach(({ tag }, i) => parts.push(i32(i + 1), box, u64(1), i32(tag), u64(0)));

    parts.push("\n$EndEntities\n$Nodes\n", u64(1, vertices, 1, vertices), i32(2, 1, 0), u64(vertices));
    const numbers = new Section();
    inBlocks(vertices, (first, length) => numbers.put(int64s(length, (i) => first + i + 1)));
    parts.push(...numbers.blobs(), ...this.points.blobs(), "\n$EndNodes\n$Elements\n");

    parts.push(u64(curves.length + surfaces.length, this.elements, 1, this.elements));
    for (const [groups, dimension, type, width] of [
      [curves, 1, 1, 3],
      [surfaces, 2, 2, 4],
    ] as const)
      groups.forEach(({ section }, i) => {
        parts.push(i32(dimension, i + 1, type), u64(section.size / (8 * width)), ...section.blobs());
      });
    return new Blob([...parts, "\n$EndElements\n"]);
  }
}

const crcTable = Uint32Array.from({ length: 256 }, (_, byte) => {
  let crc = byte;
  for (let bit = 0; bit < 8; ++bit) crc = crc & 1 ? 0xedb88320 ^ (crc >>> 1) : crc >>> 1;
  return crc;
});

// Of the pieces, one behind the other.
async function crc32(pieces: Blob[]): Promise<number> {
  let crc = -1;
  for (const piece of pieces)
    for (const byte of new Uint8Array(await piece.arrayBuffer()))
      crc = crcTable[(crc ^ byte) & 0xff]! ^ (crc >>> 8);
  return ~crc >>> 0;
}

// The head of a .npy file (version 1.0), padded to a multiple of 64 bytes.
function npyHead(type: string, rows: number, columns: number): Blob {
  let text = `{'descr': '${type}', 'fortran_order': False, 'shape': (${rows},${columns === 1 ? "" : ` ${columns}`}), }`;
  text += " ".repeat(63 - ((10 + text.length) % 64)) + "\n";
  const prefix = Uint8Array.from([0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0, text.length & 255, text.length >> 8]);
  return new Blob([prefix, text]);
}

// NumPy's archive: a zip file whose entries are stored as they are (PKWARE's APPNOTE.TXT, 4.3), with
// sizes of 64 bits.
class Npz implements MeshWriter {
  private readonly arrays = [
    { name: "points.npy", type: "<f8", width: 8, columns: 2, body: new Section() },
    { name: "triangles.npy", type: "<u4", width: 4, columns: 3, body: new Section() },
    { name: "regions.npy", type: "<i4", width: 4, columns: 1, body: new Section() },
    { name: "edges.npy", type: "<u4", width: 4, columns: 2, body: new Section() },
    { name: "edge_markers.npy", type: "<i4", width: 4, columns: 1, body: new Section() },
  ];

  constructor({ markers, regions }: MeshNames) {
    this.addNames("marker", markers);
    this.addNames("region", regions);
  }

  // NumPy's texts have one length, and are padded with zeros.
  private addNames(kind: string, names: Names): void {
    if (names.size === 0) return;
    const sorted = [...names].sort(([a], [b]) => a - b);
    const texts = sorted.map(([, name]) => Array.from(name, (letter) => letter.codePointAt(0)!));
    const longest = Math.max(...texts.map(({ length }) => length));
    const ids = new Section();
    ids.put(Int32Array.from(sorted, ([id]) => id));
    const table = new Section();
    table.put(Uint32Array.from(texts.flatMap((text) => [...text, ...Array<number>(longest - text.length).fill(0)])));
    this.arrays.push(
      { name: `${kind}_ids.npy`, type: "<i4", width: 4, columns: 1, body: ids },
      { name: `${kind}_names.npy`, type: `<U${longest}`, width: 4 * longest, columns: 1, body: table },
    );
  }

  add(piece: MeshPiece): void {
    [
      Float64Array.from(piece.coordinates),
      Uint32Array.from(piece.triangles),
      int32s(piece.regions, piece.triangles.length / 3),
      Uint32Array.from(piece.edges),
      int32s(piece.edgeMarkers, piece.edges.length / 2),
    ].forEach((values, i) => this.arrays[i]!.body.put(values));
  }

  async finish(): Promise<Blob> {
    const u16 = (...numbers: number[]) => Uint16Array.from(numbers);
    const u32 = (...numbers: number[]) => Uint32Array.from(numbers);
    const version = 45;
    const date = (46 << 9) | 0x21; // 1 January 2026: the same mesh gives the same file
    const in64 = 0xffffffff;
    const files: BlobPart[] = [];
    const directory: BlobPart[] = [];
    let at = 0;
    for (const { name, type, width, columns, body } of this.arrays) {
      const content = [npyHead(type, body.size / (width * columns), columns), ...body.blobs()];
      const size = content.reduce((sum, piece) => sum + piece.size, 0);
      const crc = await crc32(content);
      const common = (extra: number) =>
        new Blob([u16(version, 0, 0, 0, date), u32(crc, in64, in64), u16(name.length, extra)]);
      const local = new Blob([u32(0x04034b50), common(20), name, u16(1, 16), u64(size, size)]);
      files.push(local, ...content);
      directory.push(
        new Blob([u32(0x02014b50), u16(version), common(28), u16(0, 0, 0), u32(0, in64), name]),
        new Blob([u16(1, 24), u64(size, size, at)]),
      );
      at += local.size + size;
    }
    const entries = new Blob(directory);
    const count = this.arrays.length;
    return new Blob([
      ...files,
      entries,
      new Blob([u32(0x06064b50), u64(44), u16(version, version), u32(0, 0), u64(count, count)]),
      new Blob([u64(entries.size, at), u32(0x07064b50, 0), u64(at + entries.size), u32(1)]),
      new Blob([u32(0x06054b50), u16(0, 0, 0xffff, 0xffff), u32(in64, in64), u16(0)]),
    ]);
  }
}

// Wavefront: a vertex may stand anywhere before the faces that have it.
class Obj implements MeshWriter {
  private readonly lines = new Section();
  private readonly edges = new Section();
  private region: number | undefined;
  private marker: number | undefined;
  private readonly regions: Names;
  private readonly markers: Names;

  constructor({ markers, regions }: MeshNames) {
    this.regions = spelled(regions, objGroup);
    this.markers = spelled(markers, objGroup);
  }

  add(piece: MeshPiece): void {
    const { coordinates: c, triangles: t, edges: e } = piece;
    let text = "";
    for (let i = 0; i < c.length; i += 2) text += `v ${c[i]} ${c[i + 1]} 0\n`;
    for (let i = 0; i < t.length; i += 3) {
      const region = piece.regions[i / 3] ?? 0;
      if (region !== this.region) text += `g ${this.regions.get(region) ?? `region_${region}`}\n`;
      this.region = region;
      text += `f ${t[i]! + 1} ${t[i + 1]! + 1} ${t[i + 2]! + 1}\n`;
    }
    this.lines.text(text);
    text = "";
    for (let i = 0; i < e.length; i += 2) {
      const marker = piece.edgeMarkers[i / 2] ?? 0;
      if (marker !== this.marker) text += `g ${this.markers.get(marker) ?? `marker_${marker}`}\n`;
      this.marker = marker;
      text += `l ${e[i]! + 1} ${e[i + 1]! + 1}\n`;
    }
    this.edges.text(text);
  }

  finish(): Blob {
    return new Blob([...this.lines.blobs(), ...this.edges.blobs()]);
  }
}

class Off implements MeshWriter {
  private readonly points = new Section();
  private readonly faces = new Section();
  private vertices = 0;
  private triangles = 0;

  add(piece: MeshPiece): void {
    const { coordinates: c, triangles: t } = piece;
    let text = "";
    for (let i = 0; i < c.length; i += 2) text += `${c[i]} ${c[i + 1]} 0\n`;
    this.points.text(text);
    text = "";
    for (let i = 0; i < t.length; i += 3) text += `3 ${t[i]} ${t[i + 1]} ${t[i + 2]}\n`;
    this.faces.text(text);
    this.vertices += c.length / 2;
    this.triangles += t.length / 3;
  }

  finish(): Blob {
    const head = `OFF\n${this.vertices} ${this.triangles} 0\n`;
    return new Blob([head, ...this.points.blobs(), ...this.faces.blobs()]);
  }
}

// Stanford's, binary.
class Ply implements MeshWriter {
  private readonly points = new Section();
  private readonly faces = new Section();

  add({ coordinates, triangles }: MeshPiece): void {
    this.points.put(inSpace(coordinates));
    const faceBytes = 13;
    const faces = new DataView(new ArrayBuffer((faceBytes * triangles.length) / 3));
    for (let i = 0; i < triangles.length; ++i) {
      const at = faceBytes * Math.floor(i / 3);
      if (i % 3 === 0) faces.setUint8(at, 3);
      faces.setUint32(at + 1 + 4 * (i % 3), triangles[i]!, true);
    }
    this.faces.put(faces);
  }

  finish(): Blob {
    const head =
      `ply\nformat binary_little_endian 1.0\ncomment weft\nelement vertex ${this.points.size / 24}\n` +
      `property double x\nproperty double y\nproperty double z\nelement face ${this.faces.size / 13}\n` +
      "property list uchar int vertex_indices\nend_header\n";
    return new Blob([head, ...this.points.blobs(), ...this.faces.blobs()]);
  }
}

export const formats = {
  vtu: { for: "ParaView", begin: (names) => new Vtu(names) },
  msh: { for: "Gmsh 4.1", begin: (names) => new Msh(names) },
  npz: { for: "NumPy", begin: (names) => new Npz(names) },
  obj: { for: "Wavefront", begin: (names) => new Obj(names) },
  ply: { for: "Stanford, triangles alone", begin: () => new Ply() },
  off: { for: "Geomview, triangles alone", begin: () => new Off() },
} satisfies Record<string, { for: string; begin: (names: MeshNames) => MeshWriter }>;

// The extension of a file.
export type Format = keyof typeof formats;
