// SPDX-License-Identifier: Apache-2.0
// What a file calls its markers and regions, by the rules of files/formats/names.h.

import type { GenerateMeshRequest } from "../gen/weft/v1/mesh_service_pb";

export type Names = Map<number, string>; // by the number of the marker or region

export interface MeshNames {
  markers: Names;
  regions: Names;
}

// What the request of a mesh calls them.
export function namesOf(request: GenerateMeshRequest | undefined): MeshNames {
  const table = (names: { id: number; name: string }[] = []): Names => new Map(names.map(({ id, name }) => [id, name]));
  const domain = request?.domain;
  return { markers: table(domain?.markerNames), regions: table(domain?.regionNames) };
}

// The first of several names of one number, or numbers of one name, counts.
export class NameReader {
  readonly names: Names = new Map();
  readonly warnings: string[] = [];
  private readonly used = new Set<string>();

  constructor(private readonly kind: "marker" | "region") {}

  add(id: number, name: string): void {
    if (this.names.get(id) === name) return;
    const why = this.fault(id, name);
    if (why) return void this.warnings.push(`a name of ${this.kind} ${id} is left out: ${why}`);
    this.names.set(id, name);
    this.used.add(name);
  }

  private fault(id: number, name: string): string | undefined {
    if (new TextEncoder().encode(name).length > 255) return "it has more than 255 bytes";
    if (/[\0-\x1f\x7f-\x9f]/.test(name)) return "it has a control character";
    if (/\p{Surrogate}|\ufffd/u.test(name)) return "it is not UTF-8";
    if (this.names.has(id)) return `the first is “${this.names.get(id)}”`;
    if (this.used.has(name)) return `“${name}” is another one's, too`;
    return undefined;
  }
}

// Markers or regions that features give by number or by name. A name alone gets the smallest positive
// number that the file does not use, in the order in which the names appear, so numbers are known once
// all is read.
export class Labels {
  readonly reader: NameReader;
  private readonly labels: (number | string)[] = [];
  private readonly known = new Map<number | string, number>(); // its place in `labels`

  constructor(kind: "marker" | "region") {
    this.reader = new NameReader(kind);
  }

  // A label for it, the same each time. `name`: beside a number that is not 0, the name of the number.
  of(number: number, name: string): number {
    if (name && number !== 0) this.reader.add(number, name);
    const what = number !== 0 || !name ? number : name;
    const label = this.known.get(what) ?? this.labels.push(what) - 1;
    this.known.set(what, label);
    return label;
  }

  // The number of each label; call once, last.
  numbers(): number[] {
    let free = 1;
    return this.labels.map((what) => {
      if (typeof what === "number") return what;
      while (this.known.has(free)) ++free;
      this.reader.add(free, what);
      return free++;
    });
  }
}
