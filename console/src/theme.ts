// SPDX-License-Identifier: Apache-2.0
// Dark or light: what the browser prefers, until a person says otherwise.
import { useEffect, useState } from "preact/hooks";

export type Theme = "light" | "dark";

const key = "weft-theme";
const changed = "weft-theme";
const preferred = matchMedia("(prefers-color-scheme: dark)");

function stored(): Theme | undefined {
  const value = localStorage.getItem(key);
  return value === "light" || value === "dark" ? value : undefined;
}

function apply(): void {
  const theme = stored();
  if (theme) document.documentElement.dataset.theme = theme;
}

apply();

const currentTheme = (): Theme => stored() ?? (preferred.matches ? "dark" : "light");

export function setTheme(theme: Theme): void {
  localStorage.setItem(key, theme);
  apply();
  dispatchEvent(new Event(changed));
}

export function useTheme(): Theme {
  const [theme, setValue] = useState(currentTheme);
  useEffect(() => {
    const look = () => setValue(currentTheme());
    addEventListener(changed, look);
    preferred.addEventListener("change", look);
    return () => {
      removeEventListener(changed, look);
      preferred.removeEventListener("change", look);
    };
  }, []);
  return theme;
}
