// SPDX-License-Identifier: Apache-2.0
// A domain from GeoJSON (RFC 7946), with the properties marker, region, their names, max_area and max_edge
// of features.
// Errors (FileError) name the path of the offender, such as features[3].geometry.coordinates[0].
import { FileError } from "./file-error";
import { GeometryBuilder, noProperties, type Properties } from "./geometry-builder";
import type { PlanarDomain, Point } from "./planar-domain";
import { numberOf } from "./text";

type Json = { [name: string]: unknown };

const deepest = 64;
const equilateral = 0.4330127018922193; // area of the triangle of edges 1

export function readGeoJson(name: string, text: string): PlanarDomain {
  let root: unknown;
  try {
    root = JSON.parse(text);
  } catch (error) {
    throw new FileError("", `this is not JSON: ${(error as Error).message}`);
  }
  const builder = new GeometryBuilder();
  read(root, "", noProperties, builder, 0);
  const domain = builder.finish(name);
  const system = systemOf(root as Json);
  const code = system.toLowerCase().split(/[:/#]/).pop()!;
  if (system ? wgs84.has(code) || geographic.has(code) : looksGeographic(domain.points))
    domain.warnings.push(
      "the coordinates are longitudes and latitudes: lengths, areas and angles are those of degrees; on the command line, --lonlat has them on the ground",
    );
  if (system && !wgs84.has(code))
    domain.warnings.push(`its crs is “${system}”, not WGS 84 as GeoJSON's is; coordinates are taken as they are`);
  return domain;
}

// What the names of systems in longitude and latitude end with: of WGS 84, and of those that the coastlines and
// boundaries of many countries come in.
const wgs84 = new Set(["crs84", "4326", "4979"]);
const geographic = new Set(["crs27", "crs83", "4258", "4267", "4269", "4283", "4490", "4617", "4674", "7844"]);

// What the member crs, of GeoJSON before RFC 7946, names, if anything.
function systemOf({ crs }: Json): string {
  if (crs === undefined || crs === null) return "";
  const name = isObject(crs) && isObject(crs.properties) ? crs.properties.name : undefined;
  return typeof name === "string" ? name : shown(crs);
}

// GeoJSON is in longitude and latitude, but drawings in a plane are written as GeoJSON, too: most of these lie
// around the origin, or have round coordinates.
function looksGeographic(points: Float64Array): boolean {
  let [west, east, south, north, fine] = [180, -180, 90, -90, 0];
  points.forEach((value, i) => {
    if (i % 2 === 0) [west, east] = [Math.min(west, value), Math.max(east, value)];
    else [south, north] = [Math.min(south, value), Math.max(north, value)];
    if (Math.abs(1000 * value - Math.round(1000 * value)) > 1e-6) fine++; // more than three decimals
  });
  const onEarth = -180 <= west && east <= 180 && -90 <= south && north <= 90;
  const aroundOrigin = west <= 0 && 0 <= east && south <= 0 && 0 <= north;
  return onEarth && !aroundOrigin && 2 * fine >= points.length;
}

const member = (path: string, name: string) => (path ? `${path}.${name}` : name);

function read(json: unknown, path: string, properties: Properties, builder: GeometryBuilder, depth: number): void {
  if (depth > deepest) throw new FileError(path, `is nested deeper than ${deepest} levels`);
  if (!isObject(json)) throw new FileError(path, "is not a GeoJSON object");
  const each = (list: string) => {
    const items = json[list];
    if (!Array.isArray(items)) throw new FileError(path, `has no array "${list}"`);
    items.forEach((item, i) => {
      const place = `${member(path, list)}[${i}]`;
      if (item === null) builder.leftOut.add("geometry", place);
      else read(item, place, properties, builder, depth + 1);
    });
  };
  switch (json.type) {
    case "FeatureCollection":
      return each("features");
    case "GeometryCollection":
      return each("geometries");
    case "Feature":
      if (json.geometry === undefined) throw new FileError(path, 'has no "geometry"');
      if (json.geometry === null) return;
      return read(json.geometry, member(path, "geometry"), propertiesOf(json, path, builder), builder, depth + 1);
    default:
      return geometry(json, path, properties, builder);
  }
}

function isObject(json: unknown): json is Json {
  return typeof json === "object" && json !== null && !Array.isArray(json);
}

function propertiesOf(feature: Json, path: string, builder: GeometryBuilder): Properties {
  const properties = feature.properties;
  if (!isObject(properties)) return noProperties;
  // The member of a name; otherwise the first, in the order of the alphabet, that only capitals tell apart, as
  // databases write them.
  const keys = Object.keys(properties).sort();
  const given = (name: string) =>
    Object.hasOwn(properties, name) ? properties[name] : properties[keys.find((key) => lowerCase(key) === name) ?? ""];
  const number = (name: string, what: string, holds: (value: number) => boolean) => {
    const value = valueOf(given(name));
    if (typeof value !== "number") return undefined;
    if (!holds(value)) throw new FileError(`${member(path, "properties")}.${name}`, `is ${value}, not ${what}`);
    return value;
  };
  const isId = (value: number) => value === (value | 0);
  const isPositive = (value: number) => value > 0;
  // A text instead of a number, or beside it. What is neither, and a second name, is left out.
  const text = (name: string): string => {
    const value = valueOf(given(name));
    const beside = given(`${name}_name`) ?? "";
    const leaveOut = (property: string, what: string) => builder.leaveOutProperty(`${member(path, "properties")}.${property}`, what);
    if (value !== undefined && value !== null && typeof value !== "string" && typeof value !== "number")
      leaveOut(name, `${shown(value)}, neither a number nor a text`);
    if (typeof beside !== "string") leaveOut(`${name}_name`, `${shown(beside)}, not a text`);
    const called = typeof beside === "string" && beside.trim() ? beside : "";
    if (typeof value !== "string") return called;
    if (called && called !== value) leaveOut(`${name}_name`, `“${called}” beside the name “${value}”`);
    return value;
  };
  const bound = (name: string) => {
    const value = valueOf(given(name));
    if (value !== undefined && value !== null && typeof value !== "number")
      throw new FileError(`${member(path, "properties")}.${name}`, `is ${JSON.stringify(value)}, not a number`);
    return number(name, "positive", isPositive);
  };
  const maxArea = bound("max_area");
  const maxEdge = bound("max_edge");
  const bounds = [maxArea, maxEdge && equilateral * maxEdge * maxEdge].filter((bound) => bound !== undefined);
  return {
    marker: number("marker", "an integer of 32 bits", isId) ?? 0,
    region: number("region", "an integer of 32 bits", isId),
    maxArea: bounds.length > 0 ? Math.min(...bounds) : undefined,
    markerName: text("marker"),
    regionName: text("region"),
  };
}

const shown = (value: unknown) => {
  const text = JSON.stringify(value);
  return text.length > 40 ? `${text.slice(0, 40)}...` : text;
};

const lowerCase = (text: string) => text.replace(/[A-Z]/g, (letter) => letter.toLowerCase());

// A text that is a number is that number; one of blanks is nothing.
function valueOf(property: unknown): unknown {
  if (typeof property !== "string") return property;
  return numberOf(property) ?? (property.trim() ? property : undefined);
}

function geometry(json: Json, path: string, properties: Properties, builder: GeometryBuilder): void {
  const type = String(json.type);
  const many = type.startsWith("Multi");
  const kind = many ? type.slice(5) : type;
  const takers: Record<string, (value: unknown, place: string) => void> = {
    Point: (value, place) => builder.point(position(value, place)),
    LineString: (value, place) => builder.line(positions(value, place), place, properties),
    Polygon: (value, place) =>
      builder.polygon(
        list(value, place, "an array of rings").map((ring, i) => positions(ring, `${place}[${i}]`)),
        place,
        properties,
      ),
  };
  const take = Object.hasOwn(takers, kind) ? takers[kind] : undefined;
  if (!take) throw new FileError(path, `has the type “${type}”, which is not GeoJSON's`);
  const place = member(path, "coordinates");
  const coordinates = list(json.coordinates, place, "an array");
  if (coordinates.length === 0) builder.leftOut.add("geometry", path || "the geometry");
  else if (!many) take(coordinates, place);
  else
    coordinates.forEach((part, i) => {
      if (Array.isArray(part) && part.length === 0) builder.leftOut.add("geometry", `${place}[${i}]`);
      else take(part, `${place}[${i}]`);
    });
}

function list(json: unknown, path: string, what: string): unknown[] {
  if (!Array.isArray(json)) throw new FileError(path, `is not ${what}`);
  return json;
}

function position(json: unknown, path: string): Point {
  const [x, y]: unknown[] = Array.isArray(json) ? json : [];
  if (typeof x !== "number" || typeof y !== "number") throw new FileError(path, "is not a position [x, y]");
  return [x, y];
}

function positions(json: unknown, path: string): Point[] {
  return list(json, path, "an array of positions").map((each, i) => position(each, `${path}[${i}]`));
}
