// SPDX-License-Identifier: Apache-2.0
// A chunk's image in a fixed size, with its mip levels, so that thousands of them are drawn at once.

export const thumbnailSide = 32;
export const thumbnailLevels = 6; // 32, 16, 8, 4, 2 and 1 pixels wide

// Levels follow each other, the finest first. `pixels` are those of ChunkPicture.grid.
export function thumbnailOf(pixels: Uint8Array, width: number, height: number): Uint8Array {
  const levels: Uint8Array[] = [];
  for (let side = thumbnailSide; side >= 1; side /= 2) {
    const last = levels.at(-1);
    levels.push(last ? scaled(last, 2 * side, 2 * side, side) : scaled(pixels, width, height, side));
  }
  const all = new Uint8Array(levels.reduce((sum, level) => sum + level.length, 0));
  let at = 0;
  for (const level of levels) {
    all.set(level, at);
    at += level.length;
  }
  return all;
}

// Means of the cells that a pixel covers, one at least; the third byte, a slot, is that of one of them.
// A pixel that is covered by a quarter counts as full, so that neighbouring chunks leave no seam.
function scaled(from: Uint8Array, width: number, height: number, side: number): Uint8Array {
  const to = new Uint8Array(4 * side * side);
  for (let row = 0; row < side; ++row) {
    const [low, high] = stretch(row, side, height);
    for (let column = 0; column < side; ++column) {
      const [left, right] = stretch(column, side, width);
      let angle = 0, area = 0, slot = 0, covered = 0;
      for (let y = low; y < high; ++y)
        for (let x = left; x < right; ++x) {
          const at = 4 * (y * width + x);
          angle += from[at];
          area += from[at + 1];
          if (from[at + 3] > 0) slot = from[at + 2];
          covered += from[at + 3];
        }
      const most = 255 * (right - left) * (high - low);
      const cells = (covered >= most / 4 ? covered : most) / 255;
      to.set([angle / cells, area / cells, slot, covered / cells].map(Math.round), 4 * (row * side + column));
    }
  }
  return to;
}

function stretch(i: number, side: number, length: number): [number, number] {
  const from = Math.floor((i * length) / side);
  return [from, Math.max(from + 1, Math.floor(((i + 1) * length) / side))];
}
