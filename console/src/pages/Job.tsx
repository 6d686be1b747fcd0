// SPDX-License-Identifier: Apache-2.0
export function JobPage({ id }: { id: string }) {
  return (
    <section class="page">
      <h1>Job</h1>
      <p>{id}</p>
    </section>
  );
}
