// SPDX-License-Identifier: Apache-2.0
import {useState} from 'preact/hooks';
import {asApiError, type ApiError} from '../api/client';

export interface Action {
  /** Does it, unless it is being done. Whether it succeeded. */
  run: () => Promise<boolean>;
  isBusy: boolean;
  complaint: ApiError | null;
  forget: () => void;
}

/** Something that is asked of the daemon: busy for as long as the request, and its error kept for a Complaint. */
export function useAction(act: () => Promise<unknown>): Action {
  const [isBusy, setBusy] = useState(false);
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  const run = async () => {
    if (isBusy) return false;
    setBusy(true);
    setComplaint(null);
    try {
      await act();
      return true;
    } catch (error) {
      setComplaint(asApiError(error));
      return false;
    } finally {
      setBusy(false);
    }
  };
  return {run, isBusy, complaint, forget: () => setComplaint(null)};
}
