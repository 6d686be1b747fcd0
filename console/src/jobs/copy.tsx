// SPDX-License-Identifier: Apache-2.0
// Copies a text, and says so.
import { useEffect, useState } from "preact/hooks";

export function Copy({ label, text }: { label: string; text: string }) {
  const [said, setSaid] = useState("");
  useEffect(() => {
    if (!said) return;
    const timer = setTimeout(() => setSaid(""), 1500);
    return () => clearTimeout(timer);
  }, [said]);
  const copy = async () => {
    // Browsers have a clipboard for pages only if they came encrypted or from this machine.
    try {
      await navigator.clipboard.writeText(text);
      setSaid("Copied");
    } catch {
      setSaid("This browser does not let the page copy");
    }
  };
  return (
    <button type="button" class="quiet" title={text} onClick={copy} aria-live="polite">
      {said || label}
    </button>
  );
}
