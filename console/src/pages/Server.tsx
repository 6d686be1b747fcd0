// SPDX-License-Identifier: Apache-2.0
export function ServerPage() {
  return (
    <section class="page">
      <h1>Server</h1>
      
    </section>
  );
}
