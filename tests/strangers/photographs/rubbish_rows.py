# SPDX-License-Identifier: Apache-2.0
"""Rubbish: ten thousand files, huge texts, half a copy, a folder that is written while it is read, archives."""
import io
import os
import tarfile
import threading
import time
import zipfile
import numpy as np
from folder import IMAGES, LIGHTS, light_file, names, pictures, png16, then
from png import png
from png_rows import CLEAN, cut
from row import Row, refused, right, runs
from scene import u16

GOOD = pictures('.png', png16)
UNLIT = pictures('.png', png16, lamps=None)
LIGHTS_OF = ('lights', '.')
LOOK = ('look', '.')


def directions(folder, text=None):
    (folder / 'lights.txt').write_text(text or '\n'.join('%.6f %.6f %.6f' % tuple(v) for v in LIGHTS))


def thousands(folder, count=10000):
    """Copies of one small picture."""
    png(folder / 'f0.png', u16(IMAGES[0][:2, :2]))
    data = (folder / 'f0.png').read_bytes()
    for k in range(1, count):
        (folder / f'f{k}.png').write_bytes(data)


def thousands_of_texts(folder, count=10000):
    for k in range(count):
        (folder / f'note {k}.txt').write_bytes(b'x')


def text_of(folder, megabytes, line, name='lights.lp'):
    with open(folder / name, 'wb') as out:
        block = line * (1 + (1 << 20) // len(line))
        for _ in range(megabytes):
            out.write(block[:(1 << 20) // len(line) * len(line)])


def half_copied(folder):
    for name in names('.png')[5:]:
        cut(folder / name, 0.4)


def growing(folder):
    """The last photograph is written for ten seconds, or until the folder is gone."""
    data = (folder / '10.png').read_bytes()
    (folder / '10.png').write_bytes(data[:100])

    def write():
        try:
            for at in range(100, 200):
                with open(folder / '10.png', 'r+b') as out:
                    out.seek(at)
                    out.write(data[at:at + 1])
                time.sleep(0.1)
        except OSError:
            pass
    threading.Thread(target=write, daemon=True).start()


def arriving(folder):
    """Files come while the folder is read."""
    def write():
        for k in range(300):
            try:
                (folder / f'new{k}.png.part').write_bytes(b'x' * 1000)
                (folder / f'new{k}.png.part').rename(folder / f'new{k}.txt')
            except OSError:
                return
            time.sleep(0.01)
    threading.Thread(target=write, daemon=True).start()


def tar_outwards(folder):
    with tarfile.open(folder / 'cloth.tar', 'w') as out:
        for name, kind, target in (('link', tarfile.SYMTYPE, '/etc'), ('../escaped.png', tarfile.REGTYPE, ''),
                                   ('hard', tarfile.LNKTYPE, '/etc/passwd')):
            info = tarfile.TarInfo(name)
            info.type, info.linkname, info.size = kind, target, 3 if kind == tarfile.REGTYPE else 0
            out.addfile(info, io.BytesIO(b'abc'))


def zip_outwards(folder):
    with zipfile.ZipFile(folder / 'cloth.zip', 'w') as out:
        out.writestr('../../escaped.png', b'abc')
        link = zipfile.ZipInfo('link')
        link.external_attr = 0o120777 << 16
        out.writestr(link, '/etc')


def linked_outwards(folder):
    (folder / 'far').symlink_to('/etc')
    (folder / 'up').symlink_to('..')
    (folder / 'self').symlink_to('self')


def deep(folder):
    for k in range(60):
        folder = folder / 'deeper'
        folder.mkdir()


TEN_THOUSAND = then(thousands, lambda d: light_file(d / 'lights.lp', [f'f{k}.png' for k in range(10000)],
                                                    np.resize(LIGHTS, (10000, 3))))
SIZES = pictures('.png', lambda p, i, k: png(p, u16(i[k:, k:])))

ROWS = [
    Row('ten thousand pictures under ten lights', refused(65, '10 lights', '10000 photographs'), then(thousands, directions)),
    Row('ten thousand of one picture, listed', refused(65, 'two lights'), TEN_THOUSAND),
    Row('ten thousand of one picture, lights', runs('10000 lights'), TEN_THOUSAND, LIGHTS_OF),
    Row('ten thousand pictures, looked at', runs('f9999.png', '2 x 2, 16 bits'), thousands, LOOK),
    Row('ten thousand texts beside the photographs', right(CLEAN), then(GOOD, thousands_of_texts)),
    Row('a light file of 100 MB', refused(65, 'lights.lp', 'too large'), then(UNLIT, lambda d: text_of(d, 100, b'01.png 0.1 0.2 0.9\n'))),
    Row('a light file of 100 MB, lights', refused(65, 'lights.lp', 'too large'), then(
        UNLIT, lambda d: text_of(d, 100, b'01.png 0.1 0.2 0.9\n')), LIGHTS_OF),
    Row('a light file of 7 MB', refused(65, 'lights.lp', '01.png'), then(UNLIT, lambda d: text_of(d, 7, b'01.png 0.1 0.2 0.9\n'))),
    Row('a light file of one line of 7 MB', refused(65, 'lights.lp'), then(UNLIT, lambda d: text_of(d, 7, b'0.1 '))),
    Row('a light file of 7 MB of brackets', refused(65, 'lights.lp'), then(UNLIT, lambda d: text_of(d, 7, b'['))),
    Row('half a million lights', refused(65, '10 photographs'), then(UNLIT, lambda d: text_of(d, 7, b'0.6 0.0 0.8\n', 'lights.txt'))),
    Row('JSON of 100 MB', refused(66, 'no light file'), then(UNLIT, lambda d: text_of(d, 100, b'{"a": 1}\n', 'a.json'))),
    Row('a mask of 100 MB that is none', refused(65, 'mask.png'), then(GOOD, lambda d: text_of(d, 100, b'no', 'mask.png'))),
    Row('half of them half copied', refused(65, '06.png'), then(GOOD, half_copied)),
    Row('half of them half copied, looked at', runs('06.png', 'cannot be read', '05.png'), then(GOOD, half_copied), LOOK),
    Row('half of them half copied, lights', runs('10 lights'), then(GOOD, half_copied), LIGHTS_OF),
    Row('one is still being written', refused(65, '10.png'), then(GOOD, growing), is_written=True),
    Row('others arrive meanwhile', right(CLEAN), then(GOOD, arriving), is_written=True),
    Row('all of other sizes', refused(65, '02.png', 'size'), SIZES),
    Row('all of other sizes, looked at', runs('48 x 40', '47 x 39', '39 x 31'), SIZES, LOOK),
    Row('nothing to look at', refused(66, 'no pictures'), lambda d: None, LOOK),
    Row('no folder to look at', refused(66, 'nowhere'), lambda d: None, ('look', 'nowhere')),
    Row('a pipe to look at', runs('04.png', 'pipe'), then(GOOD, lambda d: ((d / '04.png').unlink(), os.mkfifo(d / '04.png'))), LOOK),
    Row('three lights, looked at', runs('3 lights'), then(UNLIT, lambda d: light_file(d / 'lights.lp', names('.png')[:3])), LIGHTS_OF),
    Row('two lights, lights', runs('2 lights'), then(UNLIT, lambda d: light_file(d / 'lights.lp', names('.png')[:2])), LIGHTS_OF),
    Row('no lights', refused(66, 'no light file'), UNLIT, LIGHTS_OF),
    Row('a tar with links outwards', refused(65, 'cloth.tar'), tar_outwards, ('look', 'cloth.tar')),
    Row('a zip with links outwards', refused(65, 'cloth.zip'), zip_outwards, ('look', 'cloth.zip')),
    Row('a tar given for photographs', refused(66, 'cloth.tar'), tar_outwards, ('solve', '--photos', 'cloth.tar', '-o', 'out')),
    Row('links out of the folder and to itself', right(CLEAN), then(GOOD, linked_outwards)),
    Row('sixty folders deep', right(CLEAN), then(GOOD, deep)),
]
