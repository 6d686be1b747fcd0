// SPDX-License-Identifier: Apache-2.0
// A domain from Triangle's .poly: points, segments with markers, holes, regions, and names in comments. Errors (FileError)
// name the line. The points of a .node beside it cannot be read, because a page is given one file.
import { FileError } from "./file-error";
import { NameReader } from "./names";
import type { PlanarDomain, RegionSeed } from "./planar-domain";
import { numberOf } from "./text";

class Lines {
  private at = 0;
  private line = 0;
  private words: string[] = [];

  constructor(private readonly text: string) {}

  // Whether there is another line that is neither blank nor a comment.
  tryNext(): boolean {
    while (this.at < this.text.length) {
      let end = this.text.indexOf("\n", this.at);
      if (end < 0) end = this.text.length;
      const line = this.text.slice(this.at, end);
      this.at = end + 1;
      ++this.line;
      const said = line.split("#", 1)[0].trim();
      if (/\d,\d/.test(said) && /\s/.test(said))
        throw this.error(`the commas of “${said}” may be decimal marks, or separate numbers`);
      this.words = said.split(/[\s,]+/).filter(Boolean).reverse();
      if (this.words.length > 0) return true;
    }
    return false;
  }

  next(what: string): void {
    if (!this.tryNext()) throw new FileError("", `the file ends before ${what}`);
  }

  get atEnd(): boolean {
    return this.words.length === 0;
  }

  real(what: string): number {
    const word = this.words.pop();
    if (word === undefined) throw this.error(`${what} is missing`);
    const value = numberOf(word);
    if (value === undefined) throw this.error(`${what} is “${word}”, not a number`);
    return value;
  }

  integer(what: string): number {
    const value = this.real(what);
    if (!Number.isSafeInteger(value)) throw this.error(`${what} is ${value}, not an integer`);
    return value;
  }

  // An integer of 32 bits.
  marker(what: string): number {
    const value = this.integer(what);
    if (value !== (value | 0)) throw this.error(`${what} is ${value}, not an integer of 32 bits`);
    return value;
  }

  // Each counted thing takes a line, so a count beyond the rest of the text is wrong.
  count(what: string): number {
    const value = this.integer(what);
    if (value < 0 || value > this.text.length) throw this.error(`${what} is ${value}`);
    return value;
  }

  get place(): string {
    return `line ${this.line}`;
  }

  error(what: string): FileError {
    return new FileError(this.place, what);
  }
}

export function readPoly(name: string, text: string): PlanarDomain {
  const lines = new Lines(text);
  lines.next("the point count");
  const count = lines.count("the point count");
  if (count === 0) throw lines.error("the points are in a .node file; put them into the .poly file");
  const dimension = lines.atEnd ? 2 : lines.integer("the dimension");
  if (dimension !== 2) throw lines.error(`the dimension is ${dimension}, it must be 2`);
  const points = new Float64Array(2 * count);
  const indices = new Map<number, number>(); // of the points, by their numbers
  for (let i = 0; i < count; ++i) {
    lines.next("a point");
    const number = lines.integer("the point number");
    if (indices.has(number)) throw lines.error(`the point number is ${number}, as that of another one before it`);
    indices.set(number, i);
    points[2 * i] = lines.real("the x coordinate");
    points[2 * i + 1] = lines.real("the y coordinate");
  }

  lines.next("the segment count");
  const segmentCount = lines.count("the segment count");
  // Without it, a segment has the marker that its line ends in.
  const marked = lines.atEnd ? undefined : lines.integer("the marker count") === 1;
  const warnings: string[] = [];
  const segments = new Uint32Array(2 * segmentCount);
  const markers = new Int32Array(segmentCount);
  for (let i = 0; i < segmentCount; ++i) {
    lines.next("a segment");
    lines.integer("the segment number");
    for (const end of [0, 1]) {
      const number = lines.integer(`the segment's ${end === 0 ? "first" : "second"} point`);
      const index = indices.get(number);
      if (index === undefined) throw lines.error(`there is no point ${number}`);
      segments[2 * i + end] = index;
    }
    if (marked ?? !lines.atEnd) markers[i] = lines.marker("the segment marker");
    else if (!lines.atEnd && warnings.length === 0)
      warnings.push(`${lines.place}: what follows the points of segments is ignored, because their header says that they have 0 markers`);
  }

  lines.next("the hole count");
  const holes = new Float64Array(2 * lines.count("the hole count"));
  for (let i = 0; i < holes.length; i += 2) {
    lines.next("a hole");
    [holes[i], holes[i + 1]] = readSeed(lines);
  }
  const names = { marker: new NameReader("marker"), region: new NameReader("region") };
  const regions = readRegions(lines, names.region);
  // As files/formats/triangle/triangle_names.h has them.
  for (const [, kind, id, called] of text.matchAll(/^# (marker|region)=(-?\d+):([^\n]*?)\t*$/gm))
    if (Number(id) === (Number(id) | 0)) names[kind as keyof typeof names].add(Number(id), called!);
  return {
    name, points, segments, markers, holes, regions, areas: [], borders: new Uint32Array(),
    markerNames: names.marker.names,
    regionNames: names.region.names,
    warnings: [...warnings, ...names.marker.warnings, ...names.region.warnings],
  };
}

function readSeed(lines: Lines): [number, number] {
  lines.integer("the seed number");
  return [lines.real("the x coordinate"), lines.real("the y coordinate")];
}

// The optional last section.
function readRegions(lines: Lines, names: NameReader): RegionSeed[] {
  if (!lines.tryNext()) return [];
  const regions: RegionSeed[] = [];
  const attributes: number[] = [];
  const count = lines.count("the region count");
  for (let i = 0; i < count; ++i) {
    lines.next("a region");
    const [x, y] = readSeed(lines);
    const attribute = lines.real("the region's attribute");
    // A lone value is both.
    const maxArea = lines.atEnd ? attribute : lines.real("the region's maximum area");
    attributes.push(attribute);
    regions.push({ x, y, id: 0, maxArea: maxArea > 0 ? maxArea : undefined });
  }
  if (lines.tryNext()) throw lines.error("the file goes on after its last region");
  const ids = regionIds(attributes);
  regions.forEach((region, i) => (region.id = ids.get(attributes[i])!));
  for (const [value, id] of ids) if (value !== id) names.add(id, String(value));
  return regions;
}

// An attribute is an id if it is an integer of 32 bits; the others, in ascending order, get the
// smallest positive ids that are free.
function regionIds(attributes: number[]): Map<number, number> {
  const isId = (value: number) => value === (value | 0);
  const ids = new Map(attributes.filter(isId).map((value) => [value, value]));
  let free = 1;
  const taken = new Set(ids.values());
  for (const value of [...new Set(attributes)].filter((value) => !isId(value)).sort((a, b) => a - b)) {
    while (taken.has(free)) ++free;
    taken.add(free);
    ids.set(value, free);
  }
  return ids;
}
