# SPDX-License-Identifier: Apache-2.0
"""Raw files: mosaics that weft simulates, whole, cut, mixed with developed ones."""
import json
import shutil
import numpy as np
from exr import read_normals
from folder import IMAGES, jpeg, light_file, png16
from png_rows import cut
from row import SOLVE, Row, refused, right, runs

SCENE = '''[camera]
width = 64
height = 48
mm_per_pixel = 0.25
[geometry]
kind = "sphere"
radius_mm = 20
contact_deg = 50
[material]
albedo = 0.6
[effects]
noise = true
'''
SIMULATE = (('simulate', 'scene.toml', '-o', 'session.weft', '-q'),)


def written(folder):
    (folder / 'scene.toml').write_text(SCENE)


def taken(listed=True, then=lambda folder: None):
    """The lit photographs and their lights, without the session."""
    def after(folder):
        session = folder / 'session.weft'
        lights = json.loads((session / 'calibration' / 'lights.json').read_text())['lights']
        names = []
        for k in range(len(lights)):
            names.append(f'raw{k + 1:02}.dng')
            next((session / 'raw').glob(f'*_led{k + 1:02}.dng')).rename(folder / names[-1])
        directions = np.array([each['direction'] for each in lights])
        (session / 'truth' / 'normal.exr').rename(folder.parent / 'truth.exr')
        shutil.rmtree(session)
        if listed:
            light_file(folder / 'lights.lp', names, directions)
        else:
            np.savetxt(folder / 'light_directions.txt', directions)
        then(folder)
    return after


def truth(folder):
    return read_normals(folder.parent / 'truth.exr')


def raws(name, must, after, run=SOLVE):
    return Row(name, must, written, run, SIMULATE, after)


ROWS = [
    raws('mosaics', right(1.5, 'mosaic|sensor', truth=truth), taken()),
    raws('mosaics by a bare list', right(1.5, 'order of their names', truth=truth), taken(False)),
    raws('mosaics and pictures of the same names', right(1.5, truth=truth), taken(then=lambda d: [
        png16(d / f'raw{k + 1:02}.png', IMAGES[k]) for k in range(10)])),
    raws('one cut in half', refused(65, 'raw04.dng'), taken(then=lambda d: cut(d / 'raw04.dng', 0.5))),
    raws('one without its last row', refused(65, 'raw04.dng'), taken(then=lambda d: cut(d / 'raw04.dng', 0.98))),
    raws('an empty one', refused(65, 'raw04.dng'), taken(then=lambda d: cut(d / 'raw04.dng', 0))),
    raws('one twice', refused(65, 'raw02.dng'), taken(then=lambda d: shutil.copy(d / 'raw02.dng', d / 'raw05.dng'))),
    raws('one under another lamp', right(1.5, 'photograph 5 (raw05.dng) fits none', 'photograph 2 (raw02.dng)',
                                         'it was left out', truth=truth),
         taken(then=lambda d: (d / 'raw05.dng').write_bytes((d / 'raw02.dng').read_bytes() + b'\0'))),
    raws('a JPEG under the name of one', refused(65, 'mix'), taken(then=lambda d: jpeg()(d / 'raw04.dng', IMAGES[0]))),
    raws('a raw of another body', refused(65, 'cr3'), taken(then=lambda d: (d / 'lights.lp').write_text(
        (d / 'lights.lp').read_text().replace('raw04.dng', 'raw04.cr3'))
        and (d / 'raw04.cr3').write_bytes(b'\0\0\0\x18ftypcrx ' + b'\0' * 500))),
    raws('looked at', runs('raw01.dng', '64 x 48', 'mosaic'), taken(), ('look', '.')),
]
