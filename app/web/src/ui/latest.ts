// SPDX-License-Identifier: Apache-2.0
import {type Inputs, useEffect} from 'preact/hooks';

type Latest = <T>(asked: Promise<T>) => Promise<T>;

/** An effect that asks: of what `latest` was given the last alone is answered, and none once the effect has ended. */
export function useLatest(begin: (latest: Latest) => void | (() => void), inputs: Inputs): void {
  useEffect(() => {
    let last: unknown;
    let isOver = false;
    const latest: Latest = (asked) => {
      if (!isOver) last = asked;
      return new Promise((take, refuse) => {
        asked.then((answer) => last === asked && take(answer), (error: unknown) => {
          if (last === asked) refuse(error);
        });
      });
    };
    const end = begin(latest);
    return () => {
      isOver = true;
      last = null;
      end?.();
    };
  }, inputs);
}
