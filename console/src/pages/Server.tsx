// SPDX-License-Identifier: Apache-2.0
// The server: what it works on, what it may do.
import { usePoll } from "../live/poll";
import { meshes as service } from "../client";
import "./pages.css";
import { Problem } from "../live/problem";
import { bytesText, numberText } from "../jobs/summary-facts";
import { countText } from "../jobs/job-parts";
import { durationText } from "../live/times";
import { Chart } from "../server/chart";
import { history, look } from "../server/history";
import { byLabel, rates, total } from "../server/metrics";

const between = 2000; // ms

function Tile({ name, value, of, varies = true }: { name: string; value: string; of?: string; varies?: boolean }) {
  return (
    <div class="tile card">
      <dt>{name}</dt>
      <dd data-varies={varies || undefined}>
        {value} {of && <span class="faint">of {of}</span>}
      </dd>
    </div>
  );
}

export function ServerPage() {
  const info = usePoll("server", (signal) => service.getServerInfo({}, { signal }), () => 30_000);
  const metrics = usePoll("metrics", look, () => between);
  const now = metrics.value;
  const samples = history();
  const server = info.value;
  const limits = server?.limits;
  const processor = rates(samples, "processSeconds").at(-1)?.perSecond;
  const hits = now && total(now, "weft_cache_hits_total");
  const asked = now && total(now, "weft_cache_hits_total") + total(now, "weft_cache_misses_total");
  return (
    <section aria-labelledby="title" class="page">
      <header class="page-head">
        <h1 id="title">Server</h1>
        {server && (
          <span class="faint">
            weftd {server.version}, engine {server.engineVersion}, {server.threads} {server.threads === 1 ? "thread" : "threads"}
          </span>
        )}
      </header>
      <Problem of={metrics.problem ?? info.problem} />
      {now && (
        <dl class="tiles">
          <Tile
            name="Threads at work"
            value={processor === undefined ? "–" : processor.toFixed(1)}
            of={server && String(server.threads)}
          />
          <Tile
            name="Meshes at work"
            value={countText(total(now, "weft_running_jobs"))}
            of={limits && String(limits.maxConcurrentJobs)}
          />
          <Tile name="Waiting" value={countText(total(now, "weft_queue_length"))} />
          <Tile
            name="Memory promised"
            value={bytesText(total(now, "weft_admission_bytes"))}
            of={limits && bytesText(limits.maxAdmittedBytes)}
          />
          <Tile
            name="From the cache"
            value={asked ? `${Math.round((100 * hits!) / asked)} %` : "–"}
            of={asked ? `${countText(asked)} asked for` : undefined}
          />
          <Tile name="Triangles made" value={countText(total(now, "weft_triangles_total"))} />
        </dl>
      )}
      <div class="charts">
        <Chart
          title="Triangles a second"
          points={rates(samples, "triangles").map(({ at, perSecond }) => [at, perSecond])}
          text={(value) => countText(Math.round(value))}
        />
        <Chart
          title="Threads at work"
          points={rates(samples, "processSeconds").map(({ at, perSecond }) => [at, perSecond])}
          least={server?.threads}
          text={(value) => value.toFixed(1)}
        />
        <Chart
          title="Memory promised"
          points={samples.map(({ at, admittedBytes }) => [at, admittedBytes])}
          text={bytesText}
        />
      </div>
      {limits && (
        <div class="columns">
          <section aria-labelledby="limits" class="card">
            <h2 id="limits">A request may have</h2>
            <dl class="facts">
              {(
                [
                  ["Points", countText(limits.maxPoints)],
                  ["Segments", countText(limits.maxSegments)],
                  ["Triangles", countText(limits.maxTriangles)],
                  ["Memory", bytesText(limits.maxBytes)],
                  ["Time", durationText(limits.maxSeconds)],
                  ["Minimum angle", `${numberText(limits.maxMinAngleDeg)}°`],
                  ["Message", bytesText(limits.maxRequestBytes)],
                ] as const
              ).map(([name, text]) => (
                <div key={name}>
                  <dt>{name}</dt>
                  <dd>{text}</dd>
                </div>
              ))}
            </dl>
          </section>
          <section aria-labelledby="kept" class="card">
            <h2 id="kept">Jobs and calls</h2>
            {server?.jobs ? (
              <dl class="facts">
                {(
                  [
                    ["Jobs that may wait", countText(server.jobs.maxQueued)],
                    ["Jobs of one client that may wait", countText(server.jobs.maxQueuedPerClient)],
                    ["Attempts at a job", String(server.jobs.maxAttempts)],
                    ["Jobs and meshes are kept for", durationText(server.jobs.keepSeconds)],
                    ["Meshes are kept up to", bytesText(server.jobs.keepBytes)],
                    ["Calls that may wait", countText(limits.maxWaitingCalls)],
                  ] as const
                ).map(([name, text]) => (
                  <div key={name}>
                    <dt>{name}</dt>
                    <dd>{text}</dd>
                  </div>
                ))}
              </dl>
            ) : (
              <p>This server keeps no jobs: it was started without <code>--data</code> and <code>--store</code>.</p>
            )}
          </section>
        </div>
      )}
      {now && <Ended counts={byLabel(now, "weft_jobs_total", "state")} />}
    </section>
  );
}

function Ended({ counts }: { counts: Map<string, number> }) {
  const text = ["succeeded", "failed", "cancelled"].map((state) => `${countText(counts.get(state) ?? 0)} ${state}`).join(", ");
  return <p class="faint" data-varies>Jobs since the server started: {text}.</p>;
}
