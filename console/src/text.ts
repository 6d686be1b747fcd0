// SPDX-License-Identifier: Apache-2.0
// Numbers as a person writes them.

export const count = (value: number | bigint): string => value.toLocaleString("en-US");

// Four digits.
export function figure(value: number): string {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-3 || size >= 1e7) return value.toExponential(2).replace("e+", "e");
  return Number(value.toPrecision(4)).toLocaleString("en-US", { maximumSignificantDigits: 4 });
}

export function seconds(value: number): string {
  if (value < 1) return `${Math.max(1, Math.round(1000 * value))} ms`;
  if (value < 60) return `${value.toFixed(value < 10 ? 2 : 1)} s`;
  return `${Math.floor(value / 60)} min ${Math.round(value % 60)} s`;
}

// 1.2 M, 340 k.
export function short(value: number): string {
  for (const [unit, letter] of [[1e9, "G"], [1e6, "M"], [1e3, "k"]] as const)
    if (value >= 0.9995 * unit) return `${Number((value / unit).toPrecision(3))} ${letter}`;
  return value.toPrecision(3).replace(/\.0*$/, "");
}
