// SPDX-License-Identifier: Apache-2.0
// The console: its bar, its banners and the page of the current path.
import { render } from "preact";
import { useState } from "preact/hooks";
import { ComparePage } from "./pages/Compare";
import { JobPage } from "./pages/Job";
import { JobsPage } from "./pages/Jobs";
import { MeshPage } from "./pages/Mesh";
import { MeshOfPage } from "./pages/MeshOf";
import { ServerPage } from "./pages/Server";
import { match, useLinks, usePath } from "./router";
import { setToken, useSession } from "./session";
import { setTheme, useTheme } from "./theme";

function Page({ path }: { path: string }) {
  let found;
  if (match("/", path)) return <MeshPage />;
  if (match("/jobs", path)) return <JobsPage />;
  if ((found = match("/job/:id", path))) return <JobPage key={path} id={found.id} />;
  if ((found = match("/mesh/:digest", path))) return <MeshOfPage key={path} digest={found.digest} />;
  if ((found = match("/compare/:a/:b", path))) return <ComparePage key={path} a={found.a} b={found.b} />;
  if (match("/server", path)) return <ServerPage />;
  return (
    <section class="page">
      <h1>There is no such page</h1>
      <p>
        <a href="/">Make a mesh</a> instead.
      </p>
    </section>
  );
}

function Bar({ path }: { path: string }) {
  const links = [
    ["/", "Mesh", path === "/"],
    ["/jobs", "Jobs", /^\/(jobs?|mesh|compare)(\/|$)/.test(path)],
    ["/server", "Server", path === "/server"],
  ] as const;
  return (
    <header class="bar">
      <a class="brand" href="/" aria-label="weft, to the first page">
        <img src="/weft.svg" alt="" width="22" height="22" />
        weft
      </a>
      <nav aria-label="Pages">
        {links.map(([href, name, here]) => (
          <a href={href} aria-current={here ? "page" : undefined}>
            {name}
          </a>
        ))}
      </nav>
      <ThemeSwitch />
      <Token />
    </header>
  );
}

function ThemeSwitch() {
  const theme = useTheme();
  const other = theme === "dark" ? "light" : "dark";
  return (
    <button class="quiet" type="button" onClick={() => setTheme(other)} title={`Use ${other} colours`}>
      {theme === "dark" ? "☾ Dark" : "☼ Light"}
    </button>
  );
}

// Asked for if the server wants one; can be changed at any time.
function Token() {
  const { token, tokenWanted } = useSession();
  const [open, setOpen] = useState(false);
  const [text, setText] = useState("");
  if (!open && !tokenWanted)
    return (
      <button class="quiet" type="button" onClick={() => setOpen(true)}>
        {token ? "Change token" : "Set token"}
      </button>
    );
  const submit = (event: Event) => {
    event.preventDefault();
    setToken(text.trim());
    setText("");
    setOpen(false);
  };
  return (
    <form class="token" onSubmit={submit}>
      <label for="token">{tokenWanted ? (token ? "Token refused. Another:" : "The server needs a token:") : "Token:"}</label>
      <input
        id="token"
        type="password"
        autocomplete="off"
        autofocus
        value={text}
        onInput={(event) => setText(event.currentTarget.value)}
      />
      <button type="submit">Use</button>
    </form>
  );
}

function App() {
  const path = usePath();
  const session = useSession();
  useLinks();
  return (
    <>
      <a class="skip" href="#content">
        To the content
      </a>
      <Bar path={path} />
      {session.away !== undefined && (
        <p class="banner" role="alert">
          The server does not answer. This page goes on by itself as soon as it does.
        </p>
      )}
      <main id="content" tabIndex={-1}>
        <Page path={path} />
      </main>
    </>
  );
}

render(<App />, document.body);
