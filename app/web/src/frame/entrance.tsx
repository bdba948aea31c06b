// SPDX-License-Identifier: Apache-2.0
// How one comes in: by the token behind the # of the link, by the cookie of before, or by typing the token.
import {useEffect, useState} from 'preact/hooks';
import {answer, api, type ApiError} from '../api/client';
import {useAction} from '../ui/action';
import {Button} from '../ui/button';
import {Complaint} from '../ui/complaint';
import {Field} from '../ui/field';

const again_ms = 1000;

export async function logIn(token: string): Promise<void> {
  await answer(api.POST('/api/v1/login', {body: {token}}));
}

/** The token of the link, taken off the address before anything else can read it there. */
export function takeToken(): string {
  const token = decodeURIComponent(location.hash.slice(1));
  if (location.hash) history.replaceState(null, '', location.pathname + location.search);
  return token;
}

/** `linked`: the token of the link, which waits for a daemon that was not there. */
export function Entrance({error, linked, onEntered}: {error: ApiError; linked: string; onEntered: () => Promise<void>}) {
  const [token, setToken] = useState(linked);
  const enter = useAction(async () => {
    const said = token.replace(/^.*#/, '').trim();
    if (said !== '') await logIn(said);
    await onEntered();
  });
  const {status} = enter.complaint ?? error;
  const isGone = status === 0;
  useEffect(() => {
    if (!isGone || enter.isBusy) return undefined;
    const timer = setTimeout(() => void enter.run(), again_ms);
    return () => clearTimeout(timer);
  }, [isGone, enter.isBusy]);
  if (status !== 401) {
    return (
      <main class="entrance">
        <h1>weft</h1>
        <Complaint error={enter.complaint ?? error} />
        <Button kind="main" isDisabled={enter.isBusy} onClick={() => void enter.run()}>Try again</Button>
      </main>
    );
  }
  return (
    <main class="entrance">
      <h1>weft</h1>
      <p>This rig asks for its token. It stands in the link that <code>weft serve</code> prints, behind the #.</p>
      <Field label="Token or link" type="password" value={token} onInput={setToken} onEnter={() => void enter.run()} />
      <Button kind="main" isDisabled={enter.isBusy || token === ''} onClick={() => void enter.run()}>Come in</Button>
      <Complaint error={enter.complaint} />
    </main>
  );
}
