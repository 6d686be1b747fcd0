// SPDX-License-Identifier: Apache-2.0
// A domain from a file, by the extension of its name.
import { FileError } from "./file-error";
import { readGeoJson } from "./geojson";
import type { PlanarDomain } from "./planar-domain";
import { readPoly } from "./poly";
import { cleanText } from "./text";
import { readWkt } from "./wkt";

const readers = new Map([
  [".poly", readPoly],
  [".geojson", readGeoJson],
  [".json", readGeoJson],
  [".wkt", readWkt],
]);

export const extensions = [...readers.keys()];

export function readDomain(name: string, text: string): PlanarDomain {
  const reader = readers.get(/\.\w+$/.exec(name)?.[0].toLowerCase() ?? "");
  if (!reader)
    throw new FileError("", `the console reads ${extensions.join(", ")}; \`weft convert\` makes a .poly of the others`);
  return reader(name, cleanText(text));
}
