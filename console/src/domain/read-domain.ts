// SPDX-License-Identifier: Apache-2.0
// A domain from a file, by the extension of its name.
import { FileError } from "./file-error";
import { readGeoJson } from "./geojson";
import type { PlanarDomain } from "./planar-domain";
import { readPoly } from "./poly";
import { readWkt } from "./wkt";

const readers: Record<string, (name: string, text: string) => PlanarDomain> = {
  poly: readPoly,
  geojson: readGeoJson,
  json: readGeoJson,
  wkt: readWkt,
};

export const extensions = Object.keys(readers).map((extension) => `.${extension}`);

export function readDomain(name: string, text: string): PlanarDomain {
  const reader = readers[/\.(\w+)$/.exec(name)?.[1].toLowerCase() ?? ""];
  if (!reader)
    throw new FileError("", `the console reads ${extensions.join(", ")}; \`weft convert\` makes a .poly of the others`);
  return reader(name, text);
}
