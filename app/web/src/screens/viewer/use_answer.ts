// SPDX-License-Identifier: Apache-2.0
import {useEffect, useRef, useState} from 'preact/hooks';
import {type ApiError, asApiError} from '../../api/client';
import {Latest} from './latest';

interface Answered<Question, Answer> {
  question: Question;
  answer: Answer;
}

const PAUSE_MS = 60;

/** The answer to a question that changes while a hand moves; it stands beside the question that it belongs to. */
export function useAnswer<Question, Answer>(question: Question | null, ask: (question: Question) => Promise<Answer>) {
  const [answered, setAnswered] = useState<Answered<Question, Answer> | null>(null);
  const [complaint, setComplaint] = useState<ApiError | null>(null);
  const asking = useRef(ask);
  asking.current = ask;
  const latest = useRef<Latest<Question, Answer> | null>(null);
  latest.current ??= new Latest<Question, Answer>(
    (each) => asking.current(each),
    (answer, each) => {
      setComplaint(null);
      setAnswered({question: each, answer});
    },
    (error) => setComplaint(asApiError(error)),
    PAUSE_MS,
  );
  useEffect(() => {
    if (question !== null) latest.current?.want(question);
  }, [JSON.stringify(question)]);
  useEffect(() => () => latest.current?.forget(), []);
  return {answered: question === null ? null : answered, complaint};
}
