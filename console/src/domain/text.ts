// SPDX-License-Identifier: Apache-2.0
// Text as programs of any system write it, by the rules of files/bytes/file_contents.h and
// number_text.h.
import { FileError } from "./file-error";

// Of a file's bytes: UTF-8, or UTF-16 with a byte order mark.
export function decodeText(bytes: ArrayBuffer): string {
  const [first, second] = new Uint8Array(bytes);
  const mark = (first << 8) | second;
  const encoding = mark === 0xfffe ? "utf-16le" : mark === 0xfeff ? "utf-16be" : "utf-8";
  if (encoding === "utf-8") return new TextDecoder().decode(bytes);
  try {
    return new TextDecoder(encoding, { fatal: true }).decode(bytes);
  } catch {
    throw new FileError("", "the file begins as UTF-16, but is not");
  }
}

// Without a byte order mark, and with line feeds at the ends of its lines.
export function cleanText(text: string): string {
  return text.replace(/^\ufeff/, "").replace(/\r+\n|\r/g, "\n");
}

const decimal = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;
const fortran = /^([+-]?(?:\d+\.?\d*|\.\d+))d([+-]?\d+)$/i; // 1.0D+03
const withoutLetter = /^([+-]?(?:\d+\.\d*|\.\d+))([+-]\d{3})$/; // 1.0+103

// The finite number that a text is as a whole; undefined if it is none.
export function numberOf(text: string): number | undefined {
  const word = text.trim().replace(fortran, "$1e$2").replace(withoutLetter, "$1e$2");
  const value = decimal.test(word) ? Number(word) : NaN;
  return Number.isFinite(value) ? value : undefined;
}
