// SPDX-License-Identifier: Apache-2.0
// What the fields of the Mesh page say, as texts, and the request that they make.
import { create } from "@bufbuild/protobuf";
import {
  GenerateMeshRequestSchema,
  Measure,
  Placement,
  type Domain,
  type GenerateMeshRequest,
} from "../gen/weft/v1/mesh_service_pb";

export interface FormText {
  sizeKind: "none" | "edge" | "area";
  size: string; // a number or an expression
  gradation: string; // these may be empty
  gradationWithin: boolean; // of effect with a gradation alone
  cellsAcross: string;
  minAngle: string;
  maxTriangles: string;
  snap: string;
  placement: "lattice" | "circumcentre";
}

export const emptyForm: FormText = {
  sizeKind: "edge",
  size: "",
  gradation: "",
  gradationWithin: false,
  cellsAcross: "",
  minAngle: "25",
  maxTriangles: "",
  snap: "",
  placement: "lattice",
};

export type Problems = Partial<Record<keyof FormText, string>>;

// Where the server's paths of fields are on the page.
const places: [path: RegExp, field: keyof FormText][] = [
  [/^size\.gradation/, "gradation"],
  [/^size\.cells_across/, "cellsAcross"],
  [/^size/, "size"],
  [/^quality\.min_angle_deg/, "minAngle"],
  [/^budget\.max_triangles/, "maxTriangles"],
  [/^domain\.snap/, "snap"],
];

export function fieldOf(path: string): keyof FormText | undefined {
  return places.find(([pattern]) => pattern.test(path))?.[1];
}

// Fields that an expression may name without more; the others need a file.
const known = { distance: { case: "distance", value: {} }, width: { case: "width", value: {} } } as const;

const isNumber = (text: string) => text !== "" && Number.isFinite(Number(text));

// The request, or what of the form is not a number. Whether values make sense is the server's to say.
export function requestOf(form: FormText, domain: Domain): GenerateMeshRequest | Problems {
  const problems: Problems = {};
  const number = (field: "gradation" | "cellsAcross" | "minAngle" | "maxTriangles" | "snap") => {
    const text = form[field].trim();
    if (text === "") return undefined;
    if (!isNumber(text)) problems[field] = `“${text}” is not a number`;
    return Number(text);
  };
  const size = form.size.trim();
  if (form.sizeKind !== "none" && size === "") problems.size = "a number or an expression is missing";
  const names = Object.keys(known) as (keyof typeof known)[];
  const used = isNumber(size) ? [] : names.filter((name) => new RegExp(`\\b${name}\\b`).test(size));
  const gradation = number("gradation");
  const cellsAcross = number("cellsAcross");
  const minAngleDeg = number("minAngle");
  const maxTriangles = number("maxTriangles");
  const snap = number("snap");
  if (maxTriangles !== undefined && !problems.maxTriangles && !(Number.isSafeInteger(maxTriangles) && maxTriangles >= 0))
    problems.maxTriangles = "a whole number is expected";
  if (Object.keys(problems).length > 0) return problems;
  return create(GenerateMeshRequestSchema, {
    domain: { ...domain, snap: snap ?? domain.snap },
    size: {
      field:
        form.sizeKind === "none"
          ? { case: undefined }
          : isNumber(size)
            ? { case: "constant", value: Number(size) }
            : { case: "expression", value: size },
      measure: form.sizeKind === "edge" ? Measure.EDGE : Measure.AREA,
      fields: form.sizeKind === "none" ? [] : used.map((name) => ({ name, kind: known[name] })),
      gradation,
      gradationWithin: Boolean(gradation) && form.gradationWithin,
      cellsAcross,
    },
    quality: {
      minAngleDeg,
      placement: form.placement === "circumcentre" ? Placement.CIRCUMCENTRE : Placement.LATTICE,
    },
    budget: maxTriangles === undefined ? undefined : { maxTriangles: BigInt(maxTriangles) },
    wantQuadtree: true,
  });
}

export function isRequest(made: GenerateMeshRequest | Problems): made is GenerateMeshRequest {
  return "$typeName" in made;
}
