// SPDX-License-Identifier: Apache-2.0
import type { Summary } from "../gen/weft/v1/mesh_service_pb";
import { count } from "../text";

// A sentence for each.
export function warningsOf({ sizeWarnings, outside }: Summary): string[] {
  const sentences = sizeWarnings.map(({ message }) => message);
  if (outside)
    sentences.push(
      `${count(outside.segments)} ${outside.segments === 1n ? "segment lies" : "segments lie"} outside of what is meshed, ` +
        `${outside.segments === 1n ? "" : "the first "}at (${outside.x}, ${outside.y}). Lines that do not close enclose nothing.`,
    );
  return sentences;
}
