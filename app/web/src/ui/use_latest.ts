// SPDX-License-Identifier: Apache-2.0
import {type Inputs, useEffect} from 'preact/hooks';

type Latest = <T>(asked: Promise<T>) => Promise<T>;

/** An effect that asks: of what `latest` was given the last alone is answered, and none once the effect has ended. */
export function useLatest(begin: (latest: Latest) => void | (() => void), inputs: Inputs): void {
  useEffect(() => {
    let last: unknown;
    let isOver = false;
    const end = begin((asked) => {
      last = asked;
      const isOld = () => isOver || last !== asked;
      return new Promise((take, refuse) => asked.then((answer) => isOld() || take(answer), (error: unknown) => isOld() || refuse(error)));
    });
    return () => {
      isOver = true;
      end?.();
    };
  }, inputs);
}
