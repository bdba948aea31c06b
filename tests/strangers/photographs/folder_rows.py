# SPDX-License-Identifier: Apache-2.0
"""Folders: sizes that differ, links, permissions, names, what else lies there."""
import os
import shutil
import numpy as np
from folder import COUNT, IMAGES, LIGHTS, jpeg, light_file, names, pictures, png8, png16, then
from png import png
from png_rows import CLEAN, cut
from row import SOLVE, Row, refused, right, runs, said
from scene import u16

GOOD = pictures('.png', png16)
LISTED = lambda folder: np.savetxt(folder / 'light_directions.txt', LIGHTS)
UNNAMED = then(pictures('.png', png16, lamps=None), LISTED)


def outside(folder):
    """The photographs lie elsewhere, and links to them in the folder."""
    far = folder.parent / 'far'
    far.mkdir()
    for name in names('.png'):
        (folder / name).rename(far / name)
        (folder / name).symlink_to(far / name)


def loop(folder):
    (folder / '04.png').unlink()
    (folder / '04.png').symlink_to('05.png')
    (folder / '05.png').unlink()
    (folder / '05.png').symlink_to('04.png')


def dangling(folder):
    (folder / '04.png').unlink()
    (folder / '04.png').symlink_to('/no/such/picture.png')


def pipe(folder):
    (folder / '04.png').unlink()
    os.mkfifo(folder / '04.png')


def called(files, listed=None):
    return then(pictures('.png', png16, files=files, lamps=None), LISTED)


def other(size):
    height, width = size
    return pictures('.png', lambda p, i, k: png(p, u16(np.resize(i, (height, width, 3)))), only=[6])


ROWS = [
    Row('one a row shorter', refused(65, '07.png', '48 x 39'), other((39, 48))),
    Row('one on its side', refused(65, '07.png', '40 x 48'), other((48, 40))),
    Row('one of one pixel', refused(65, '07.png', '1 x 1'), other((1, 1))),
    Row('all of one pixel', runs('1 of 1 pixels solved'), pictures('.png', lambda p, i, k: png(p, u16(i[:1, :1] + 0.001 * k)))),
    Row('all of one row', runs('48 of 48 pixels solved'), pictures('.png', lambda p, i, k: png(p, u16(i[:1])))),
    Row('links out of the folder', right(CLEAN), then(GOOD, outside)),
    Row('links in a loop', refused(66, '04.png'), then(GOOD, loop)),
    Row('a link to nothing', refused(66, '04.png'), then(GOOD, dangling)),
    Row('a pipe for a photograph', refused(65, '04.png'), then(GOOD, pipe)),
    Row('a folder linked into itself', right(CLEAN), then(GOOD, lambda d: (d / 'again').symlink_to('.'))),
    Row('a folder named like a picture', right(CLEAN), then(UNNAMED, lambda d: (d / '00.png').mkdir())),
    Row('hidden files of a Mac', right(CLEAN), then(UNNAMED, lambda d: [
        (d / f'._{n}').write_bytes(b'\0\5\x16\7' * 20) for n in names('.png')])),
    Row('thumbnails of Windows', right(CLEAN), then(UNNAMED, lambda d: (d / 'Thumbs.db').write_bytes(b'\xd0\xcf\x11\xe0' * 90))),
    Row('a picture of another name among them', right(CLEAN), then(UNNAMED, lambda d: png16(d / 'overview.png', IMAGES[0] * 0.9))),
    Row('one photograph too many', refused(65, '10 lights', '11 photographs'), then(UNNAMED, lambda d: png16(d / '11.png', IMAGES[0] * 0.9))),
    Row('one photograph too few', refused(65, '10 lights', '9 photographs'), then(UNNAMED, lambda d: (d / '10.png').unlink())),
    Row('both raw names and developed ones', right(CLEAN), then(GOOD, lambda d: [(d / n).write_bytes(b'II*\0') for n in names('.nef')])),
    Row('no photographs', refused(66, 'no photographs'), lambda d: LISTED(d)),
    Row('an empty folder', refused(66, 'no light file'), lambda d: None),
    Row('no folder', refused(66, 'nowhere'), lambda d: None, ('solve', '--photos', 'nowhere', '-o', 'out')),
    Row('a file for a folder', refused(66, '01.png'), GOOD, ('solve', '--photos', '01.png', '-o', 'out')),
    Row('names 1 to 10', right(CLEAN), called([f'{k}.png' for k in range(1, 11)])),
    Row('names of two counters', right(CLEAN), called([f'dome2_img{k}.png' for k in range(1, 11)])),
    Row('names of dates', right(CLEAN), called([f'2024-03-0{1 + k // 5} {9 + k}h.png' for k in range(10)])),
    Row('names in capitals and small letters', right(CLEAN), called([('IMG_{:02}.PNG' if k % 2 else 'img_{:02}.png').format(k) for k in range(10)])),
    Row('names of two alphabets', right(CLEAN), called([f'\u30b7\u30e7\u30c3\u30c8{k:02}.png' for k in range(10)])),
    Row('lights in the folder above', right(CLEAN, 'lights.lp in'), lambda d: (
        (d / 'cloth').mkdir(), pictures('.png', png16, lamps=None)(d / 'cloth'), light_file(d / 'lights.lp', names('.png'))),
        ('solve', '--photos', 'cloth', '-o', 'out', '--no-previews')),
    Row('a photograph that nobody may read', refused(66, '04.png', 'ermission'), then(
        GOOD, lambda d: (d / '04.png').chmod(0)), as_nobody=True),
    Row('a light file that nobody may read', refused(66, 'lights.lp', 'ermission'), then(
        GOOD, lambda d: (d / 'lights.lp').chmod(0)), as_nobody=True),
    Row('a folder of blanks and quotes', right(CLEAN, out='it s "here"'), GOOD,
        ('solve', '--photos', '.', '-o', 'it s "here"', '--no-previews')),
]
