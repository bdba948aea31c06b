// SPDX-License-Identifier: Apache-2.0
// The daemon's calls, typed by its own description, and the one kind of error that they have.
import type {components} from './schema';

export {api} from './calls';

export type Schemas = components['schemas'];

/** What the daemon said is wrong, in its own words. */
export class ApiError extends Error {
  constructor(
    readonly what: string,
    readonly where: string,
    readonly why: string,
    readonly remedy: string,
    readonly status: number,
    readonly code = '',
  ) {
    super(what);
  }

  /** For a clipboard or a letter: all that is known, line by line. */
  get text(): string {
    return [this.what, this.where, this.why, this.remedy].filter((line) => line !== '').join('\n');
  }
}

function silent(): ApiError {
  return new ApiError('The daemon does not answer.', '', 'It was stopped, or the network is down.', 'Start `weft serve`; this page goes on by itself.', 0);
}

function complaintOf(document: unknown, status: number): ApiError {
  const said = (document as Partial<Schemas['ErrorDocument']> | undefined)?.error;
  if (!said) return new ApiError(`The daemon answered ${status}.`, '', '', '', status);
  return new ApiError(said.what, said.where, said.why, said.remedy, status, said.code);
}

/** An error of any kind as one that a Complaint can show. */
export function asApiError(error: unknown): ApiError {
  if (error instanceof ApiError) return error;
  return new ApiError('The page failed.', '', String(error), 'Reload it.', 0);
}

type Call<T> = Promise<{data?: T; error?: unknown; response: Response}>;

/** The data of a call, or an ApiError thrown: `const rig = await answer(api.GET('/api/v1/rig'))`. */
export async function answer<T>(call: Call<T>): Promise<T> {
  const {data, error, response} = await call.catch(() => {
    throw silent();
  });
  if (!response.ok) throw complaintOf(error, response.status);
  return data as T;
}

/** What is no JSON: pictures, tiles, files. Throws an ApiError as `answer` does; an abort goes through. */
export async function fetched(path: string, signal?: AbortSignal): Promise<Response> {
  const response = await fetch(path, {signal}).catch((error: unknown) => {
    if (signal?.aborted) throw error;
    throw silent();
  });
  if (response.ok) return response;
  throw complaintOf(await response.json().catch(() => undefined), response.status);
}
