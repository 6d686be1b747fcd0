// SPDX-License-Identifier: Apache-2.0
// A line over the last minutes, with its latest and its largest value.
import { durationText } from "../live/times";

const fewestSeconds = 30;
const mostSeconds = 300;
const width = 300;
const height = 60;

interface Props {
  title: string;
  points: [at: number, value: number][]; // seconds, ascending
  text: (value: number) => string;
  least?: number | undefined; // of what the top of the chart stands for
}

export function Chart({ title, points, text, least = 0 }: Props) {
  const end = points.at(-1)?.[0] ?? 0;
  const seconds = Math.min(Math.max(end - (points[0]?.[0] ?? end), fewestSeconds), mostSeconds);
  const most = Math.max(...points.map(([, value]) => value), 0);
  const top = Math.max(most, least, 1e-9);
  const places = points.map(([at, value]) => {
    const x = width * (1 - (end - at) / seconds);
    return `${x.toFixed(1)},${(height * (1 - value / top)).toFixed(1)}`;
  });
  const latest = points.at(-1)?.[1];
  const label = latest === undefined ? "nothing yet" : `now ${text(latest)}, at most ${text(most)}`;
  return (
    <figure class="chart card">
      <figcaption>
        {title} <span class="faint" data-varies>{label}</span>
      </figcaption>
      <svg viewBox={`0 0 ${width} ${height}`} preserveAspectRatio="none" role="img" aria-label={`${title}: ${label}`} data-varies>
        {places.length > 1 && (
          <>
            <polygon points={`${places[0]!.split(",")[0]},${height} ${places.join(" ")} ${width},${height}`} />
            <polyline points={places.join(" ")} />
          </>
        )}
      </svg>
      <div class="histogram-ends faint">
        <span data-varies>{durationText(seconds)} ago</span>
        <span>now</span>
      </div>
    </figure>
  );
}
