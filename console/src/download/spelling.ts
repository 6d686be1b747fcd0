// SPDX-License-Identifier: Apache-2.0
// How files spell the names of markers and regions, as files/formats/format_names.h has it.
import type { Names } from "../domain/names";

const numbered = (name: string, between: string) =>
  new RegExp(`^(marker|region)${between}-?\\d+$`).test(name) ? `_${name}` : name;

export const gmshName = (name: string) => numbered(name, " ").replaceAll('"', "'");

export function objGroup(name: string): string {
  const word = name.replace(/[ ,#]/g, "_");
  return word === "default" ? `_${word}` : numbered(word, "_");
}

export const inXml = (name: string) =>
  name.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;");

// By ascending number, each in another spelling: one that another name has already gets a number, "a_b_2".
export function spelled(names: Names, spelling: (name: string) => string): Names {
  const sorted = [...names].sort(([a], [b]) => a - b);
  const wanted = new Map<string, number>(); // how often each spelling was wanted
  const out: Names = new Map();
  // Names that stay as they are come first: another one must not take their spelling.
  for (const [id, name] of sorted)
    if (spelling(name) === name) {
      out.set(id, name);
      wanted.set(name, 1);
    }
  for (const [id, name] of sorted) {
    if (out.has(id)) continue;
    const first = spelling(name);
    let text = first;
    let times = wanted.get(first) ?? 0;
    while (times++ > 0) {
      text = `${first}_${times}`;
      if (wanted.has(text)) continue;
      wanted.set(text, 1);
      break;
    }
    wanted.set(first, times);
    out.set(id, text);
  }
  return new Map([...out].sort(([a], [b]) => a - b));
}
