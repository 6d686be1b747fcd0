// SPDX-License-Identifier: Apache-2.0
// The server's metrics, as /metrics shows them in the text format of Prometheus, and the history of
// them that this page has seen.

// Values by name and labels as they stand there, such as `weft_queue_length{queue="jobs"}`.
export type Metrics = ReadonlyMap<string, number>;

// Lines that are no samples are left out.
export function parseMetrics(text: string): Metrics {
  const metrics = new Map<string, number>();
  for (const line of text.split("\n")) {
    const match = /^([a-zA-Z_:][\w:]*(?:\{.*\})?) (\S+)/.exec(line);
    if (match) metrics.set(match[1]!, Number(match[2]));
  }
  return metrics;
}

// The sum over all labels.
export function total(metrics: Metrics, name: string): number {
  let sum = 0;
  for (const [key, value] of metrics) if (key === name || key.startsWith(`${name}{`)) sum += value;
  return sum;
}

// By the value of one label.
export function byLabel(metrics: Metrics, name: string, label: string): Map<string, number> {
  const values = new Map<string, number>();
  for (const [key, value] of metrics) {
    if (!key.startsWith(`${name}{`)) continue;
    const found = new RegExp(`[{,]${label}="([^"]*)"`).exec(key)?.[1];
    if (found !== undefined) values.set(found, (values.get(found) ?? 0) + value);
  }
  return values;
}

// What the charts show, at one time in seconds.
export interface Sample {
  at: number;
  triangles: number; // made since the server started
  processSeconds: number; // of all threads
  running: number;
  waiting: number;
  admittedBytes: number;
}

export function sampleOf(metrics: Metrics, at: number): Sample {
  return {
    at,
    triangles: total(metrics, "weft_triangles_total"),
    processSeconds: total(metrics, "process_cpu_seconds_total"),
    running: total(metrics, "weft_running_jobs"),
    waiting: total(metrics, "weft_queue_length"),
    admittedBytes: total(metrics, "weft_admission_bytes"),
  };
}

export interface Rate {
  at: number;
  perSecond: number;
}

// The growth of a counter from sample to sample. One that has fallen is that of a server that was
// started anew, which begins at 0.
export function rates(samples: readonly Sample[], counter: "triangles" | "processSeconds"): Rate[] {
  return samples.slice(1).map((sample, i) => {
    const before = samples[i]!;
    const grown = sample[counter] - (sample[counter] < before[counter] ? 0 : before[counter]);
    return { at: sample.at, perSecond: grown / Math.max(sample.at - before.at, 1e-3) };
  });
}
