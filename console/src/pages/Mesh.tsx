// SPDX-License-Identifier: Apache-2.0
export function MeshPage() {
  return (
    <section class="page">
      <h1>Mesh</h1>
    </section>
  );
}
