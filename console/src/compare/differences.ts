// SPDX-License-Identifier: Apache-2.0
// What differs between two messages.

export interface Difference {
  path: string; // such as "quality.min_angle_deg"
  a: string; // "" if it is not set
  b: string;
}

function leaves(value: unknown, path: string, into: Map<string, string>): void {
  if (Array.isArray(value)) {
    value.forEach((item, i) => leaves(item, `${path}[${i}]`, into));
  } else if (typeof value === "object" && value !== null) {
    for (const [key, inner] of Object.entries(value)) leaves(inner, path ? `${path}.${key}` : key, into);
  } else {
    into.set(path, String(value));
  }
}

// The values of a message in JSON by their paths, in the order of its fields.
export function leavesOf(json: unknown): Map<string, string> {
  const into = new Map<string, string>();
  leaves(json, "", into);
  return into;
}

// Of two messages in JSON, in the order of their fields.
export function differences(a: unknown, b: unknown): Difference[] {
  const ofA = leavesOf(a);
  const ofB = leavesOf(b);
  return [...new Set([...ofA.keys(), ...ofB.keys()])]
    .map((path) => ({ path, a: ofA.get(path) ?? "", b: ofB.get(path) ?? "" }))
    .filter((difference) => difference.a !== difference.b);
}
