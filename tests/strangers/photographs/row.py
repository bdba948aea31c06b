# SPDX-License-Identifier: Apache-2.0
"""A row of the table: what lies in a folder, what is run there, and what must happen."""
import os
import subprocess
import threading
from dataclasses import dataclass, field
from pathlib import Path
from typing import Callable
import numpy as np
import scene
from exr import read_normals

SOLVE = ('solve', '--photos', '.', '-o', 'out', '--no-previews')
MOST_SECONDS, MOST_MEGABYTES = 20, 700  # of a processor; in memory
HANGS_SECONDS = 120


@dataclass
class Seen:
    code: int
    text: str
    folder: Path
    seconds: float = 0
    megabytes: float = 0


@dataclass
class Row:
    name: str
    must: Callable  # of Seen: '' or what is wrong
    make: Callable  # of the folder
    run: tuple = SOLVE
    before: tuple = field(default=())  # commands that must go well
    after: Callable = None  # of the folder, behind them
    as_nobody: bool = False  # without the rights of root
    is_written: bool = False  # somebody writes into the folder meanwhile


def without(words, text):
    """The words that a text does not have; one of those parted by | is enough."""
    small = text.lower()
    return [each for each in words if not any(part.lower() in small for part in each.split('|'))]


def right(degrees, *words, truth=None, inside=None, out='out'):
    """Normals within so many degrees of the truth; what is given as `words` is said."""
    def must(seen):
        if seen.code != 0:
            return f'exit code {seen.code}: {first_line(seen.text)}'
        missing = without(words, seen.text)
        if missing:
            return f'not a word of {missing}'
        found = read_normals(next(Path(seen.folder).glob(f'{out}/normal.exr')))
        expected = scene.normals() if truth is None else truth(seen.folder) if callable(truth) else truth
        if found.shape != expected.shape:
            return f'normals of {found.shape[1]} x {found.shape[0]}'
        off = scene.mean_degrees(found, expected, inside)
        return '' if off <= degrees else f'off by {off:.2f} degrees, {degrees} are allowed'
    must.says = f'right within {degrees}'
    return must


def said(*words, within=180.0, **more):
    must = right(within, *words, **more)
    must.says = 'said: ' + ', '.join(words)
    return must


def refused(code, *words):
    """With this exit code and words; nothing is made, changed or gone."""
    def must(seen):
        if seen.code != code:
            return f'exit code {seen.code} where {code} is expected: {first_line(seen.text)}'
        missing = without(words, seen.text)
        return f'refused without a word of {missing}: {first_line(seen.text)}' if missing else ''
    must.says, must.refuses = f'refused with {code}: ' + ', '.join(words), True
    return must


def runs(*words):
    """A verb that solves nothing ends well and says this."""
    def must(seen):
        if seen.code != 0:
            return f'exit code {seen.code}: {first_line(seen.text)}'
        missing = without(words, seen.text)
        return f'not a word of {missing}: {seen.text[:300]}' if missing else ''
    must.says = 'said: ' + ', '.join(words)
    return must


def first_line(text):
    return ' | '.join(line.strip() for line in text.splitlines() if line.strip())[:400]


def listing(folder):
    return sorted((str(p.relative_to(folder)), p.lstat().st_size, p.lstat().st_mtime_ns)
                  for p in Path(folder).rglob('*') if not p.is_dir() or p.is_symlink())


def run_weft(program, arguments, folder, as_nobody=False):
    """With its peak memory, which only wait4() tells."""
    user = None
    if as_nobody and os.geteuid() == 0:
        folder.parent.chmod(0o755)
        folder.chmod(0o777)
        user = 'nobody'
    process = subprocess.Popen([program, *arguments], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, user=user, env={**os.environ, 'LC_ALL': 'C.UTF-8', 'OMP_NUM_THREADS': '1'})
    clock = threading.Timer(HANGS_SECONDS, process.kill)  # one that hangs ends as killed
    clock.start()
    text = process.stdout.read().decode(errors='replace')
    _, status, used = os.wait4(process.pid, 0)
    clock.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    return Seen(process.returncode, text, folder, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)


def tried(row, program, folder):
    """'' or what is wrong."""
    row.make(folder)
    for arguments in row.before:
        seen = run_weft(program, arguments, folder)
        if seen.code != 0:
            return f'{" ".join(arguments)}: exit code {seen.code}: {first_line(seen.text)}'
    if row.after:
        row.after(folder)
    earlier = None if row.is_written else listing(folder)
    seen = run_weft(program, row.run, folder, row.as_nobody)
    if seen.code not in (0, 64, 65, 66):
        return f'exit code {seen.code}: {first_line(seen.text)}'
    if seen.seconds > MOST_SECONDS or seen.megabytes > MOST_MEGABYTES:
        return f'took {seen.seconds:.1f} s and {seen.megabytes:.0f} MB'
    if seen.code != 0 and not row.is_written and listing(folder) != earlier:
        return f'refused, and left {sorted({e[0] for e in listing(folder)} ^ {e[0] for e in earlier})[:4]}'
    return row.must(seen)
