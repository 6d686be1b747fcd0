// SPDX-License-Identifier: Apache-2.0
// The metrics that this page has seen in the last minutes. They are kept while the console is open, so
// that the charts go on after a look at another page.
import { Code, ConnectError } from "@connectrpc/connect";
import { noteFailure } from "../client";
import { currentSession } from "../session";
import { parseMetrics, sampleOf, type Metrics, type Sample } from "./metrics";

const keptSeconds = 300;
let samples: Sample[] = [];

export const history = (): readonly Sample[] => samples;

// Asks for the metrics, and remembers them. Throws what `explain` can put in words.
export async function look(signal: AbortSignal): Promise<Metrics> {
  try {
    const metrics = parseMetrics(await metricsText(signal));
    const now = performance.now() / 1000;
    samples = [...samples.filter(({ at }) => at > now - keptSeconds), sampleOf(metrics, now)];
    return metrics;
  } catch (error) {
    noteFailure(error);
    throw error;
  }
}

async function metricsText(signal: AbortSignal): Promise<string> {
  const { token } = currentSession();
  const headers: HeadersInit = token ? { authorization: `Bearer ${token}` } : {};
  const response = await fetch("/metrics", { signal, headers, cache: "no-store" });
  const text = await response.text();
  if (response.status === 401) throw new ConnectError(text, Code.Unauthenticated);
  if (!response.ok) throw new ConnectError(text, Code.Internal);
  return text;
}
