// SPDX-License-Identifier: Apache-2.0
export function MeshOfPage({ digest }: { digest: string }) {
  return (
    <section class="page">
      <h1>Mesh</h1>
      <p>{digest}</p>
    </section>
  );
}
