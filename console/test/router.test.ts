// SPDX-License-Identifier: Apache-2.0
import { expect, test } from "vitest";
import { match } from "../src/router";

test("a path gives the parameters of its pattern", () => {
  expect(match("/compare/:a/:b", "/compare/12/ab%20c")).toEqual({ a: "12", b: "ab c" });
  expect(match("/jobs", "/jobs/")).toEqual({});
});

test("other paths do not match", () => {
  expect(match("/job/:id", "/job/")).toBeUndefined();
  expect(match("/job/:id", "/jobs/1")).toBeUndefined();
  expect(match("/job/:id", "/job/%E0")).toBeUndefined();
});
