// SPDX-License-Identifier: Apache-2.0
// A request as what a person would type to ask for it again. The server keeps no arrays of a request,
// so the domain's file, and those of rasters and fields, are names in capitals to be filled in; if
// the domain's file is given, the request is whole.
import { getOption, hasOption, type DescField } from "@bufbuild/protobuf";
import { reflect, type ReflectMessage } from "@bufbuild/protobuf/reflect";
import {
  GenerateMeshRequestSchema,
  Measure,
  option,
  type GenerateMeshRequest,
  type Layers,
  type NamedField,
} from "../gen/weft/v1/mesh_service_pb";

export interface DomainFile {
  name: string;
  inMetres: boolean; // projected from longitude and latitude
}

type Pair = [number, number];
type Value = string | number | boolean | number[] | Pair[];

// They change no mesh.
const ofTheRun = ["threads", "want_quadtree", "no_cache"];

function valueOf(field: DescField, value: unknown): Value {
  if (field.fieldKind === "enum") return name(field.enum.value[value as number].localName);
  return typeof value === "bigint" ? Number(value) : (value as number | boolean);
}

const name = (text: string) => text.toLowerCase().replaceAll("-", "_");

// Those that are set of the options of a message that the protocol names, as Python calls them.
function namedOptions(message: ReflectMessage): [string, Value][] {
  return message.fields.flatMap((field): [string, Value][] => {
    if (!message.isSet(field)) return [];
    if (field.fieldKind === "message") return namedOptions(message.get(field));
    if (!hasOption(field, option) || ofTheRun.includes(field.name)) return [];
    return [[name(getOption(field, option).name || field.name), valueOf(field, message.get(field))]];
  });
}

function optionsOf(request: GenerateMeshRequest, domain: DomainFile | undefined): [string, Value][] {
  const options = namedOptions(reflect(GenerateMeshRequestSchema, request));
  if (domain?.inMetres) options.push(["to_metres", true]);
  const { keep, periodic = [] } = request.quality ?? {};
  if (keep) options.push(["keep", keep.markers.length > 0 ? keep.markers : "all"]);
  if (periodic.length > 0) options.push(["periodic", periodic.map(({ from, to }): Pair => [from, to])]);
  return options;
}

// Name and value of what layers have besides their marker.
function rowsOf({ first, ratio, rows, region }: Layers): [string, number][] {
  const all: [string, number | undefined][] = [
    ["first", first],
    ["rows", rows],
    ["ratio", ratio || undefined],
    ["region", region],
  ];
  return all.filter((entry): entry is [string, number] => entry[1] !== undefined);
}
const rowsText = (layers: Layers, between: string) => rowsOf(layers).map((row) => row.join("=")).join(between);

// Name and value of the size, or undefined if there is no bound. `raster` stands for a grid.
function sizeOf<Raster>({ size }: GenerateMeshRequest, raster: Raster): [string, string | number | Raster] | undefined {
  if (!size?.field.case) return undefined;
  const name = size.measure === Measure.EDGE ? "edge" : "size";
  return [name, size.field.case === "raster" ? raster : size.field.value];
}

const inShell = (text: string) => (/^[\w./:=+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
const valueInShell = (value: Value) =>
  Array.isArray(value) ? value.map((item) => (Array.isArray(item) ? item.join(":") : item)).join(",") : String(value);
function inPython(value: Value): string {
  if (Array.isArray(value)) return `[${value.map((item) => (Array.isArray(item) ? `(${item.join(",")})` : item)).join(",")}]`;
  return typeof value === "boolean" ? "True" : typeof value === "number" ? String(value) : JSON.stringify(value);
}

const kinds = {
  distance: ["distance:marker=MARKERS", "weft.distance(marker=MARKERS)"],
  raster: ["RASTER.asc", 'weft.raster("RASTER.asc")'],
  mesh: ["mesh:MESH.vtu:ARRAY", 'weft.on_mesh(MESH, VALUES)'],
  width: ["width", "weft.width()"],
} satisfies Record<NonNullable<NamedField["kind"]["case"]>, [shell: string, python: string]>;

// Index 0 is for the shell, 1 for Python.
function kindOf({ kind }: NamedField, whole: boolean, language: 0 | 1): string {
  if (!kind.case) return "FIELD";
  if (kind.case === "distance" && whole && kind.value.markers.length === 0)
    return ["distance", "weft.distance()"][language];
  return kinds[kind.case][language];
}

export function shellCommand(request: GenerateMeshRequest, domain?: DomainFile): string {
  const words = [`weft mesh ${inShell(domain?.name ?? "DOMAIN.poly")} -o mesh.vtu`];
  const size = sizeOf(request, "SIZES.asc");
  if (size) words.push(`--${size[0]} ${inShell(String(size[1]))}`);
  for (const field of request.size?.fields ?? [])
    words.push(`--field ${inShell(`${field.name}=${kindOf(field, domain !== undefined, 0)}`)}`);
  for (const layers of request.quality?.layers ?? []) words.push(`--layers ${layers.marker}:${rowsText(layers, ",")}`);
  for (const [name, value] of optionsOf(request, domain)) {
    const flag = `--${name.replaceAll("_", "-")}`;
    words.push(value === true ? flag : `${flag} ${valueInShell(value)}`);
  }
  return words.join(" \\\n  ");
}

export function pythonProgram(request: GenerateMeshRequest, domain?: DomainFile): string {
  const given = [inPython(domain?.name ?? "DOMAIN.poly")];
  const size = sizeOf(request, { program: "weft.Raster(VALUES, ORIGIN, SPACING)" });
  if (size) given.push(`${size[0]}=${typeof size[1] === "object" ? size[1].program : inPython(size[1])}`);
  const fields = request.size?.fields ?? [];
  if (fields.length > 0) {
    const items = fields.map((field) => `${inPython(field.name)}: ${kindOf(field, domain !== undefined, 1)}`);
    given.push(`fields={${items.join(", ")}}`);
  }
  const layers = request.quality?.layers ?? [];
  if (layers.length > 0) {
    const items = layers.map((each) => `${each.marker}: weft.Layers(${rowsText(each, ", ")})`);
    given.push(`layers={${items.join(", ")}}`);
  }
  for (const [name, value] of optionsOf(request, domain)) given.push(`${name}=${inPython(value)}`);
  return `import weft

with weft.Client() as client:
    mesh = client.mesh(
        ${given.join(",\n        ")},
    )
mesh.write("mesh.vtu")
`;
}
