// SPDX-License-Identifier: Apache-2.0
export function JobsPage() {
  return (
    <section class="page">
      <h1>Jobs</h1>
      
    </section>
  );
}
