// SPDX-License-Identifier: Apache-2.0
// What the pages say of a job's times.

// Seconds until the work is done, if it goes on as it did; undefined if there is too little of it to
// tell. `fraction` is done, from 0 to 1, after `elapsed` seconds.
export function secondsLeft(fraction: number, elapsed: number): number | undefined {
  const least = 0.02;
  if (!(fraction >= least) || !(elapsed > 0)) return undefined;
  return elapsed * (1 / Math.min(fraction, 1) - 1);
}

// "850 ms", "3.2 s", "4 min", "2.5 h", "5 d". `step` seconds is the least that is told apart.
export function durationText(seconds: number, step = 0.001): string {
  if (step >= 1 && seconds < 9.95) return `${Math.floor(seconds)} s`;
  if (seconds < 0.9995) return `${Math.round(1000 * Math.max(seconds, 0))} ms`;
  if (seconds < 9.95) return `${seconds.toFixed(1)} s`;
  if (seconds < 99.5) return `${Math.round(seconds)} s`;
  const units = [
    ["min", 60],
    ["h", 3600],
    ["d", 86400],
  ] as const;
  const [unit, length] = units.findLast(([, length]) => seconds >= 1.5 * length) ?? units[0];
  const value = seconds / length;
  return `${value < 9.95 && unit !== "min" ? value.toFixed(1) : Math.round(value)} ${unit}`;
}
