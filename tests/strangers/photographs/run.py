# SPDX-License-Identifier: Apache-2.0
"""Folders of photographs as strangers bring them: each is solved right, told of, or refused by name."""
import argparse
import concurrent.futures
import importlib
import os
import shutil
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
from row import tried  # noqa: E402

TABLES = ('png_rows', 'tiff_rows', 'exr_rows', 'jpeg_rows', 'light_rows', 'layout_rows', 'lamp_rows', 'folder_rows',
          'raw_rows', 'rubbish_rows')


def rows_of(only):
    for table in TABLES:
        for row in importlib.import_module(table).ROWS:
            if not only or any(text in f'{table} {row.name}' for text in only):
                yield f'{table[:-5]}: {row.name}', row


def judged(name, row, program, root):
    folder = Path(tempfile.mkdtemp(prefix='row-', dir=root)) / 'cloth'
    folder.mkdir()
    try:
        return name, row, tried(row, program, folder)
    except Exception as failed:  # a row that cannot be made is a fault of the row
        return name, row, f'{type(failed).__name__}: {failed}'


def main():
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument('program', help='weft')
    arguments.add_argument('only', nargs='*', help='rows whose table and name have one of these texts')
    arguments.add_argument('-o', '--output', help='keep the folders here')
    arguments.add_argument('-j', '--jobs', type=int, default=os.cpu_count())
    arguments.add_argument('-q', '--quiet', action='store_true', help='failures and the sum')
    arguments.add_argument('--list', action='store_true', help='the table alone')
    a = arguments.parse_args()
    rows = list(rows_of(a.only))
    if a.list:
        for name, row in rows:
            print(f'{name:60} {row.must.says}')
        return 0
    root = a.output or tempfile.mkdtemp(prefix='weft-photographs-')
    Path(root).mkdir(parents=True, exist_ok=True)
    Path(root).chmod(0o755)  # for rows that run as nobody
    program, wrong = str(Path(a.program).resolve()), 0
    with concurrent.futures.ThreadPoolExecutor(a.jobs) as pool:
        for name, row, fault in pool.map(lambda each: judged(*each, program, root), rows):
            wrong += bool(fault)
            if fault or not a.quiet:
                print(f'{"WRONG" if fault else "right"}  {name}: {fault or row.must.says}', flush=True)
    if not a.output:
        shutil.rmtree(root, ignore_errors=True)
    print(f'{len(rows)} folders of photographs, {wrong} wrong')
    return 1 if wrong or not rows else 0


sys.exit(main())
