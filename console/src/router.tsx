// SPDX-License-Identifier: Apache-2.0
// Pages by path, with the browser's History. Links are plain <a href="/jobs">; useLinks makes them
// change the page without loading it anew.
import { useEffect, useState } from "preact/hooks";

const changed = "weft-navigate";

export function navigate(path: string): void {
  history.pushState(null, "", path);
  dispatchEvent(new Event(changed));
}

// The current path, such as "/job/42".
export function usePath(): string {
  const [path, setPath] = useState(location.pathname);
  useEffect(() => {
    const look = () => setPath(location.pathname);
    addEventListener(changed, look);
    addEventListener("popstate", look);
    return () => {
      removeEventListener(changed, look);
      removeEventListener("popstate", look);
    };
  }, []);
  return path;
}

// Takes over clicks on links to this origin's pages.
export function useLinks(): void {
  useEffect(() => {
    const click = (event: MouseEvent) => {
      if (event.defaultPrevented || event.button !== 0) return;
      if (event.metaKey || event.ctrlKey || event.shiftKey || event.altKey) return;
      const link = (event.target as Element).closest<HTMLAnchorElement>("a[href]");
      if (!link || link.target || link.hasAttribute("download") || link.origin !== location.origin) return;
      if (link.hash && link.pathname === location.pathname) return;
      event.preventDefault();
      navigate(link.pathname);
    };
    document.addEventListener("click", click);
    return () => document.removeEventListener("click", click);
  }, []);
}

// The parameters of `path` if it has the form of `pattern`, such as "/job/:id".
export function match(pattern: string, path: string): Record<string, string> | undefined {
  const wanted = pattern.split("/");
  const given = path.replace(/(.)\/$/, "$1").split("/");
  if (wanted.length !== given.length) return undefined;
  const found: Record<string, string> = {};
  for (let i = 0; i < wanted.length; ++i) {
    if (wanted[i].startsWith(":")) {
      if (given[i] === "") return undefined;
      try {
        found[wanted[i].slice(1)] = decodeURIComponent(given[i]);
      } catch {
        return undefined;
      }
    } else if (wanted[i] !== given[i]) {
      return undefined;
    }
  }
  return found;
}
