// SPDX-License-Identifier: Apache-2.0
// What the server said: a sentence, and below it the expression with a caret, if there is one.
export function ProblemText({ text }: { text: string }) {
  const end = text.indexOf("\n");
  if (end < 0) return <>{text}</>;
  return (
    <>
      {text.slice(0, end)}
      <pre>{text.slice(end + 1)}</pre>
    </>
  );
}
