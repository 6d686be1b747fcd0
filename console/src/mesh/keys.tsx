// SPDX-License-Identifier: Apache-2.0
// What to do here, and by which keys.
const always: [string[], string][] = [
  [["Ctrl", "Enter"], "mesh"],
  [["Esc"], "cancel"],
];

const onPicture: [string[], string][] = [
  [["←", "↑", "→", "↓"], "move, faster with Shift"],
  [["+", "−"], "zoom"],
  [["0"], "show all"],
  [["Enter"], "pick the triangle in the middle"],
  [["C"], "next colouring"],
  [["E", "Q", "W"], "edges, quadtree, worst ten"],
];

const onSketch: [string[], string][] = [
  [["←", "↑", "→", "↓"], "move the cross, faster with Shift"],
  [["Enter"], "set a corner"],
  [["C"], "close the ring"],
  [["⌫"], "take a corner back"],
];

function List({ keys }: { keys: [string[], string][] }) {
  return (
    <dl class="keys">
      {keys.map(([names, what]) => (
        <div>
          <dt>
            {names.map((name) => (
              <kbd>{name}</kbd>
            ))}
          </dt>
          <dd>{what}</dd>
        </div>
      ))}
    </dl>
  );
}

export function Keys({ drawing }: { drawing: boolean }) {
  return (
    <section class="welcome">
      <h2>{drawing ? "Draw a domain" : "Press Mesh"}</h2>
      <p class="faint">
        {drawing
          ? "Set corners with the mouse or the keys; rings inside are holes."
          : "Triangles appear while the rest is still at work. Then click one, or drag and scroll the picture."}
      </p>
      <List keys={always} />
      <p class="faint">With the focus on the picture:</p>
      <List keys={drawing ? onSketch : onPicture} />
    </section>
  );
}
