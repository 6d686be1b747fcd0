// SPDX-License-Identifier: Apache-2.0
// Asks the server again and again, because a browser has no more than six connections to it: a stream
// to each of several tabs would leave none for a mesh.
import { useEffect, useRef, useState } from "preact/hooks";

export interface Polled<T> {
  value: T | undefined; // the last that came, kept if the server goes away
  problem: unknown; // of the last try; undefined if it went well
  again: () => void; // asks at once
}

const longestPause = 5000;

// Calls `ask` whenever `key` changes, then `pause(value)` milliseconds after each answer until that
// is undefined. Rests while the page is not seen. After a failure the pauses grow, up to 5 s.
export function usePoll<T>(
  key: string,
  ask: (signal: AbortSignal) => Promise<T>,
  pause: (value: T) => number | undefined,
): Polled<T> {
  const [state, setState] = useState<{ key: string; value?: T; problem?: unknown }>({ key });
  const again = useRef(() => {});
  const calls = useRef({ ask, pause });
  calls.current = { ask, pause };

  useEffect(() => {
    const stop = new AbortController();
    let timer: ReturnType<typeof setTimeout> | undefined;
    let failures = 0;
    let asking = false;
    const later = (milliseconds: number) => {
      clearTimeout(timer);
      timer = setTimeout(look, milliseconds);
    };
    const look = async () => {
      if (asking || document.hidden) return;
      asking = true;
      try {
        const value = await calls.current.ask(stop.signal);
        if (stop.signal.aborted) return;
        failures = 0;
        setState({ key, value });
        const wait = calls.current.pause(value);
        if (wait !== undefined) later(wait);
      } catch (problem) {
        if (stop.signal.aborted) return;
        setState((before) => ({ key, value: before.key === key ? before.value : undefined, problem }));
        later(Math.min(500 * 2 ** failures++, longestPause));
      } finally {
        asking = false;
      }
    };
    const seen = () => void look();
    again.current = seen;
    document.addEventListener("visibilitychange", seen);
    addEventListener("online", seen);
    seen();
    return () => {
      stop.abort();
      clearTimeout(timer);
      document.removeEventListener("visibilitychange", seen);
      removeEventListener("online", seen);
    };
  }, [key]);

  return state.key === key
    ? { value: state.value, problem: state.problem, again: () => again.current() }
    : { value: undefined, problem: undefined, again: () => again.current() };
}
