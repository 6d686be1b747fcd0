// SPDX-License-Identifier: Apache-2.0
// A domain from well-known text: one geometry or several, between them blanks or `;`. Errors
// (FileError) name line and column.
import { FileError } from "./file-error";
import { GeometryBuilder, noProperties } from "./geometry-builder";
import type { PlanarDomain, Point } from "./planar-domain";
import { numberOf } from "./text";

const deepest = 64;

export function readWkt(name: string, text: string): PlanarDomain {
  const reader = new Reader(text);
  reader.all();
  return reader.builder.finish(name);
}

class Reader {
  readonly builder = new GeometryBuilder();
  private at = 0;

  constructor(private readonly text: string) {}

  all(): void {
    for (let i = 0; !this.atEnd(); ++i) {
      this.match(/SRID\s*=\s*\d+\s*;/iy);
      this.geometry(`geometry ${i}`, 0);
      while (this.match(/;/y));
    }
  }

  private geometry(place: string, depth: number): void {
    if (depth > deepest) throw this.error(`collections are nested deeper than ${deepest} levels`);
    const word = this.match(/[a-z]+/iy);
    if (!word) throw this.error("a geometry is expected, such as POLYGON");
    const kind = word.toUpperCase().replace(/(.)(ZM|Z|M)$/, "$1");
    this.match(/(ZM|Z|M)\b/iy);
    if (this.isEmpty()) return this.builder.leftOut.add("geometry", place);
    switch (kind) {
      case "POINT":
        return this.builder.point(this.inside(() => this.position()));
      case "MULTIPOINT":
        return this.list(() => {
          const inner = this.match(/\(/y);
          this.builder.point(this.position());
          if (inner) this.expect(")");
        });
      case "LINESTRING":
        return this.builder.line(this.positions(), place, noProperties);
      case "MULTILINESTRING":
        return this.parts(`${place}, line `, (part) => this.builder.line(this.positions(), part, noProperties));
      case "POLYGON":
        return this.polygon(place);
      case "MULTIPOLYGON":
        return this.parts(`${place}, polygon `, (part) => this.polygon(part));
      case "GEOMETRYCOLLECTION":
        return this.list((i) => this.geometry(`${place}, part ${i}`, depth + 1));
      default:
        throw this.error(`“${word}” is not a geometry that weft reads`);
    }
  }

  private polygon(place: string): void {
    const rings: Point[][] = [];
    this.list(() => rings.push(this.isEmpty() ? [] : this.positions()));
    this.builder.polygon(rings, `${place}, ring `, noProperties);
  }

  // Those of a collection, less the empty ones.
  private parts(place: string, read: (place: string) => void): void {
    this.list((i) => {
      if (this.isEmpty()) this.builder.leftOut.add("geometry", `${place}${i}`);
      else read(`${place}${i}`);
    });
  }

  private isEmpty(): boolean {
    return this.match(/EMPTY\b/iy) !== undefined;
  }

  private positions(): Point[] {
    const found: Point[] = [];
    this.list(() => found.push(this.position()));
    return found;
  }

  // Heights and measures are dropped.
  private position(): Point {
    const numbers: number[] = [];
    for (let word; (word = this.match(/[-+.\d][^\s(),;]*/y)); ) numbers.push(numberOf(word) ?? NaN);
    if (numbers.length < 2 || numbers.length > 4 || !numbers.every(Number.isFinite))
      throw this.error("a position is expected, such as 3.5 7");
    return [numbers[0], numbers[1]];
  }

  private inside<T>(read: () => T): T {
    this.expect("(");
    const value = read();
    this.expect(")");
    return value;
  }

  private list(read: (i: number) => void): void {
    this.inside(() => {
      for (let i = 0; ; ++i) {
        read(i);
        if (!this.match(/,/y)) return;
      }
    });
  }

  private expect(character: string): void {
    this.skip();
    if (this.text[this.at] !== character) throw this.error(`“${character}” is expected`);
    ++this.at;
  }

  private match(pattern: RegExp): string | undefined {
    this.skip();
    pattern.lastIndex = this.at;
    const found = pattern.exec(this.text)?.[0];
    if (found !== undefined) this.at += found.length;
    return found;
  }

  private atEnd(): boolean {
    this.skip();
    return this.at >= this.text.length;
  }

  private skip(): void {
    while (this.at < this.text.length && /\s/.test(this.text[this.at])) ++this.at;
  }

  private error(what: string): FileError {
    const before = this.text.slice(0, this.at);
    const line = before.split("\n").length;
    return new FileError(`line ${line}, column ${this.at - before.lastIndexOf("\n")}`, what);
  }
}
