// SPDX-License-Identifier: Apache-2.0
// A line a check, with its number. A verdict is {ok, says}; a twin is a broken copy, whose verdict must not be ok.

export class Report {
  passed = 0;
  failed = 0;
  skipped = 0;
  #began = performance.now();

  /** `print` gets all lines, `loud` those that nobody may miss. */
  constructor({print = () => {}, loud = (line) => process.stdout.write(`${line}\n`)} = {}) {
    this.print = print;
    this.loud = loud;
  }

  #say(line, isLoud) {
    this.print(line);
    if (isLoud) this.loud(line);
  }

  check(title, {ok, says}) {
    if (ok) this.passed += 1;
    else this.failed += 1;
    const words = says.length > longest ? `${says.slice(0, longest)} ...` : says;
    this.#say(`${ok ? 'ok     ' : 'FAILED '} ${title}: ${words}`, !ok);
    return ok;
  }

  refuses(title, {ok, says}) {
    this.check(`${title}, as it must refuse`, {ok: !ok, says: ok ? `was taken for good: ${says}` : says});
  }

  skip(title, why) {
    this.skipped += 1;
    this.#say(`skipped ${title}: ${why}`, true);
  }

  /** Runs a group; what it throws is a failure of that group and no more. */
  async group(name, work) {
    const began = performance.now();
    const before = this.passed;
    try {
      await work();
    } catch (error) {
      this.check(name, {ok: false, says: error.stack});
    }
    this.#say(`${((performance.now() - began) / 1000).toFixed(1).padStart(7)} s  ${name}: ${this.passed - before} checks`, true);
  }

  /** The exit code. */
  end() {
    this.#say(`${((performance.now() - this.#began) / 1000).toFixed(1).padStart(7)} s`, true);
    this.#say(`${this.passed} passed, ${this.failed} failed, ${this.skipped} skipped`, true);
    return this.failed > 0 || this.passed === 0 ? 1 : 0;
  }
}

const longest = 400;

/** A number that must not be above its limit; NaN is above each. */
export function below(number, limit, unit = '', more = '') {
  return {ok: number <= limit, says: `${Number(number).toPrecision(3)}${unit} (limit ${Number(limit.toPrecision(3))}${unit})${more}`};
}

/** Two lengths, by the relative difference. */
export function sameLength(read, truth, limit, unit = 'mm') {
  const off = Math.abs(read / truth - 1);
  return {ok: off <= limit, says: `${Number(read).toPrecision(8)} ${unit} for ${Number(truth).toPrecision(8)} (off ${off.toExponential(1)}, limit ${limit.toExponential(1)})`};
}

/** All of these must hold. */
export function all(verdicts) {
  const bad = verdicts.filter(({ok}) => !ok);
  const said = [...new Set((bad.length ? bad : verdicts).map(({says}) => says))];
  return {ok: bad.length === 0 && verdicts.length > 0, says: said.join('; ') || 'nothing was judged'};
}
