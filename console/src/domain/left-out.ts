// SPDX-License-Identifier: Apache-2.0
// Counts what of a file is left out because nothing can be meshed of it, as
// files/formats/domains/left_out.h does.
const kinds = {
  ring: ["ring without an area", "rings without an area"],
  line: ["line without a length", "lines without a length"],
  geometry: ["empty geometry", "empty geometries"],
} as const;

export class LeftOut {
  private readonly counts = new Map<keyof typeof kinds, number>();
  private first = "";

  add(kind: keyof typeof kinds, place: string): void {
    this.first ||= place;
    this.counts.set(kind, (this.counts.get(kind) ?? 0) + 1);
  }

  // Empty if nothing was.
  sentence(): string {
    const found = (Object.keys(kinds) as (keyof typeof kinds)[]).filter((kind) => this.counts.has(kind));
    const counts = found.map((kind) => this.counts.get(kind)!);
    const parts = found.map((kind, i) => `${counts[i]} ${kinds[kind][counts[i] === 1 ? 0 : 1]}`);
    const all = counts.reduce((sum, count) => sum + count, 0);
    if (all === 0) return "";
    const last = parts.pop();
    const list = parts.length > 0 ? `${parts.join(", ")} and ${last}` : last;
    return `${list} ${all === 1 ? "is left out:" : "are left out, the first is"} ${this.first}`;
  }
}
