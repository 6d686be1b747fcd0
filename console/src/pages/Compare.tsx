// SPDX-License-Identifier: Apache-2.0
export function ComparePage({ a, b }: { a: string; b: string }) {
  return (
    <section class="page">
      <h1>Compare</h1>
      <p>{a} {b}</p>
    </section>
  );
}
