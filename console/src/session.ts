// SPDX-License-Identifier: Apache-2.0
// What this tab knows of the server: its token, whether it wants one, whether it answers. The token
// stays in this tab and is forgotten with it.
import { useEffect, useState } from "preact/hooks";

const tokenKey = "weft-token";

export interface Session {
  token: string;
  tokenWanted: boolean; // a call was answered UNAUTHENTICATED
  away: string | undefined; // why the server does not answer
}

let session: Session = { token: sessionStorage.getItem(tokenKey) ?? "", tokenWanted: false, away: undefined };
const listeners = new Set<() => void>();

export const currentSession = (): Session => session;

export function updateSession(change: Partial<Session>): void {
  const next = { ...session, ...change };
  if ((Object.keys(change) as (keyof Session)[]).every((key) => session[key] === next[key])) return;
  session = next;
  for (const listener of listeners) listener();
}

export function setToken(token: string): void {
  sessionStorage.setItem(tokenKey, token);
  updateSession({ token, tokenWanted: false });
}

export function useSession(): Session {
  const [value, setValue] = useState(session);
  useEffect(() => {
    const look = () => setValue(session);
    listeners.add(look);
    look();
    return () => void listeners.delete(look);
  }, []);
  return value;
}
