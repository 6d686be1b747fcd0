// SPDX-License-Identifier: Apache-2.0
// Scales of colours that people who see few of them can read too: each but the qualitative one goes
// from dark to light or away from a pale middle, and none needs red told from green.

export type ColourBy = "angle" | "area" | "ratio" | "region" | "chunk" | "none";

export type Rgb = [number, number, number]; // 0 to 255

const parse = (hex: string): Rgb => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)) as Rgb;

// Small angles stand out, warm; those near 60 degrees are calm.
const angleStops = ["#7f1d0c", "#d7401b", "#f58b3c", "#fbcf78", "#e9ecd2", "#a8d5d8", "#5fa9c6", "#2f7fb0", "#1f5f96"];
// Viridis, by Smith and van der Walt.
const areaStops = ["#440154", "#482878", "#3e4989", "#31688e", "#26828e", "#1f9e89", "#35b779", "#6ece58", "#b5de2b", "#fde725"];
// Cividis, by Nunez, Anderton and Renslow.
const ratioStops = ["#00224e", "#123570", "#3b496c", "#575d6d", "#707173", "#8a8678", "#a59c74", "#c3b369", "#e1cc55", "#fee838"];
// By Okabe and Ito, then lighter ones.
const regionColours = [
  "#9fb4c4", "#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7",
  "#f3cf80", "#abdaf4", "#80cfb9", "#80b9d9", "#eaaf80", "#e6bcd3",
].map(parse);

// Of a scale at t from 0 to 1.
export function between(stops: readonly Rgb[], t: number): Rgb {
  const at = Math.min(Math.max(t, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(at), stops.length - 2);
  return stops[i].map((value, d) => Math.round(value + (at - i) * (stops[i + 1][d] - value))) as Rgb;
}

const scales = { angle: angleStops.map(parse), area: areaStops.map(parse), ratio: ratioStops.map(parse) };

export function scaleColour(by: "angle" | "area" | "ratio", t: number): Rgb {
  return between(scales[by], t);
}

export function regionColour(slot: number): Rgb {
  return slot === 0 ? regionColours[0] : regionColours[1 + ((slot - 1) % (regionColours.length - 1))];
}

// Neighbouring numbers differ well in hue and lightness.
export function chunkColour(index: number): Rgb {
  const hue = (index * 0.61803398875) % 1;
  const light = 0.55 + 0.2 * ((index * 0.41421356237) % 1);
  return [0, 8, 4].map((n) => {
    const k = (n + 12 * hue) % 12;
    return Math.round(255 * (light - 0.45 * Math.min(light, 1 - light) * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  }) as Rgb;
}

// 256 x 4 pixels: the rows are angle, area, ratio and region.
export function lookUpTable(): Uint8Array {
  const pixels = new Uint8Array(4 * 256 * 4);
  for (let i = 0; i < 256; ++i) {
    const colours = [...(["angle", "area", "ratio"] as const).map((by) => scaleColour(by, i / 255)), regionColour(i)];
    colours.forEach((colour, row) => pixels.set([...colour, 255], 4 * (256 * row + i)));
  }
  return pixels;
}

export const css = (colour: Rgb): string => `rgb(${colour.join(" ")})`;
