// SPDX-License-Identifier: Apache-2.0
// The sections of a file that are written at the same time, each to its end. What is full is handed
// to the browser as a Blob, which it may keep on its disk: a file of any size costs the page some MiB
// a section.

const blockBytes = 1 << 20;
const encoder = new TextEncoder();

export class Section {
  private parts: Blob[] = [];
  private block = new Uint8Array(blockBytes);
  private used = 0;
  private done = 0; // bytes in parts

  get size(): number {
    return this.done + this.used;
  }

  // The bytes of any array of numbers; all browsers' machines are little-endian.
  put(array: ArrayBufferView): void {
    const bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    for (let at = 0; at < bytes.length; ) {
      const count = Math.min(blockBytes - this.used, bytes.length - at);
      this.block.set(bytes.subarray(at, at + count), this.used);
      this.used += count;
      at += count;
      if (this.used === blockBytes) this.flush();
    }
  }

  text(text: string): void {
    this.put(encoder.encode(text));
  }

  blobs(): Blob[] {
    this.flush();
    return this.parts;
  }

  private flush(): void {
    if (this.used === 0) return;
    this.parts.push(new Blob([this.block.subarray(0, this.used)]));
    this.done += this.used;
    this.used = 0;
  }
}
