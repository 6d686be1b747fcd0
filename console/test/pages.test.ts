// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";
import { differences } from "../src/compare/differences";
import { durationText, secondsLeft } from "../src/live/times";
import { byLabel, parseMetrics, rates, sampleOf, total } from "../src/server/metrics";

test("two messages differ in what only one has, and in what both have otherwise", () => {
  const a = { size: { constant: 1, fields: [{ name: "h" }] }, quality: { min_angle_deg: 20 } };
  const b = { size: { constant: 2, fields: [{ name: "h" }] }, threads: 4 };
  expect(differences(a, b)).toEqual([
    { path: "size.constant", a: "1", b: "2" },
    { path: "quality.min_angle_deg", a: "20", b: "" },
    { path: "threads", a: "", b: "4" },
  ]);
  expect(differences(a, a)).toEqual([]);
});

test("what is left follows from what is done, if that is enough to tell", () => {
  expect(secondsLeft(0.25, 10)).toBe(30);
  expect(secondsLeft(0.01, 10)).toBeUndefined();
  expect(secondsLeft(1.5, 10)).toBe(0);
});

test("durations have a unit that a person would take", () => {
  expect([0, 0.85, 3.21, 42, 100, 3600 * 2.5, 86400 * 5].map((s) => durationText(s))).toEqual([
    "0 ms", "850 ms", "3.2 s", "42 s", "2 min", "2.5 h", "5.0 d",
  ]);
  expect(durationText(3.9, 1)).toBe("3 s");
});

const text = `# HELP weft_triangles_total Triangles made.
# TYPE weft_triangles_total counter
weft_triangles_total 1500
weft_jobs_total{state="succeeded",client="a"} 2
weft_jobs_total{client="b",state="succeeded"} 1
weft_jobs_total{state="failed"} 4
weft_jobs_total_seconds 9
process_cpu_seconds_total 1.5e1 1700000000
`;

test("metrics are read with their labels, and summed", () => {
  const metrics = parseMetrics(text);
  expect(total(metrics, "weft_jobs_total")).toBe(7);
  expect(total(metrics, "absent")).toBe(0);
  expect([...byLabel(metrics, "weft_jobs_total", "state")]).toEqual([["succeeded", 3], ["failed", 4]]);
  expect(sampleOf(metrics, 3)).toMatchObject({ at: 3, triangles: 1500, processSeconds: 15 });
});

test("a rate is the growth a second, from 0 if the server was started anew", () => {
  const at = (time: number, triangles: number) => ({ ...sampleOf(new Map(), time), triangles });
  expect(rates([at(0, 100), at(2, 300), at(4, 50)], "triangles")).toEqual([
    { at: 2, perSecond: 100 },
    { at: 4, perSecond: 25 },
  ]);
});
