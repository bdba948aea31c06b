# SPDX-License-Identifier: Apache-2.0
"""EXR: channel names, layers, parts, windows, chromaticities, numbers that are none."""
import struct
import numpy as np
from exr import Part, attribute, chromaticities, exr, rgb
from folder import pictures, then
from png_rows import CLEAN, cut, grey
from row import Row, refused, right, said
from scene import normals

REC709 = (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290)
ACES = (0.7347, 0.2653, 0, 1, 0.0001, -0.077, 0.32168, 0.33767)


def of(channels, only=None, **more):
    """channels(image) gives {name: rows}; those beyond `only` are plain."""
    def write(path, image, k):
        plain = only is not None and k not in only
        exr(path, Part(rgb(image)) if plain else Part(channels(image), **more))
    return pictures('.exr', write)


def parts(*made):
    return pictures('.exr', lambda path, image, k: exr(path, *[each(image) for each in made]))


def luma_chroma(image):
    y = (0.2126 * image[..., 0] + 0.7152 * image[..., 1] + 0.0722 * image[..., 2]).astype(np.float32)
    safe = np.where(y > 0, y, 1)[::2, ::2]
    return {'Y': y, 'RY': ((image[::2, ::2, 0] - y[::2, ::2]) / safe).astype(np.float32),
            'BY': ((image[::2, ::2, 2] - y[::2, ::2]) / safe).astype(np.float32)}


def y_only(image, name='Y'):
    return {name: grey(image).astype(np.float32)}


def layered(*layers):
    def channels(image):
        return {f'{layer}.{name}': rows for layer in layers for name, rows in rgb(image).items()}
    return channels


def spoilt(value, colour='G'):
    def channels(image):
        made = rgb(image)
        made[colour] = made[colour].copy()
        made[colour][20, 24] = value
        return made
    return channels


def window(path, image, k, step):
    x = y = 2 * (k % 3) if step else 2
    exr(path, Part(rgb(image[y:y + 32, x:x + 40]), origin=(x, y), display=(0, 0, 48, 40)))


def preview(image, name):
    return Part(rgb(image[::4, ::4] * 0 + 0.5), name=name, display=(0, 0, *image.shape[1::-1]))


ROWS = [
    Row('floats', right(CLEAN), of(rgb)),
    Row('halves', right(CLEAN), of(lambda i: rgb(i, np.float16))),
    Row('whole numbers', right(CLEAN), of(
        lambda i: rgb(np.round(i * 60000), np.uint32))),
    Row('halves and floats', right(CLEAN), of(lambda i: {**rgb(i), 'G': i[..., 1].astype(np.float16)})),
    Row('Y', right(CLEAN), of(y_only)),
    Row('alpha', right(CLEAN), of(lambda i: {**rgb(i), 'A': np.ones(i.shape[:2], np.float32)})),
    Row('Y and alpha', right(CLEAN), of(lambda i: {**y_only(i), 'A': np.ones(i.shape[:2], np.float32)})),
    Row('Y, RY, BY', refused(65, 'BY', 'subsampled'), of(luma_chroma, sampling=('RY', 'BY'))),
    Row('one layer', right(CLEAN), of(layered('beauty'))),
    Row('several layers', refused(65, 'diffuse.R|diffuse'), of(layered('diffuse', 'specular'))),
    Row('RGB and layers', right(CLEAN), of(lambda i: {**rgb(i), **layered('diffuse')(i[::-1])})),
    Row('RGB and depth', right(CLEAN), of(lambda i: {**rgb(i), 'Z': np.full(i.shape[:2], 1e10, np.float32)})),
    Row('RGB and normals', right(CLEAN), of(lambda i: {**rgb(i), **rgb(normals(), names=('N.X', 'N.Y', 'N.Z'))})),
    Row('small letters', refused(65, 'r, g, b'), of(lambda i: rgb(i, names='rgb'))),
    Row('names in full', refused(65, 'red, green, blue'), of(lambda i: rgb(i, names=('red', 'green', 'blue')))),
    Row('X, Y, Z', refused(65, 'X'), of(lambda i: rgb(i, names='XYZ'))),
    Row('R alone', right(CLEAN, 'R is taken as grey'), of(lambda i: y_only(i, 'R'))),
    Row('a channel without a name of light', right(CLEAN, 'depth is taken as grey'), of(lambda i: y_only(i, 'depth'))),
    Row('a grey preview in the first part', right(CLEAN), parts(lambda i: preview(i, 'preview'), lambda i: Part(rgb(i), name='photo'))),
    Row('the photograph in the first part', right(CLEAN), parts(lambda i: Part(rgb(i), name='photo'), lambda i: preview(i, 'preview'))),
    Row('two parts alike', refused(65, 'part'), parts(lambda i: Part(rgb(i), name='left'), lambda i: Part(rgb(i[::-1]), name='right'))),
    Row('depth in the other part', right(CLEAN), parts(
        lambda i: Part({'Z': np.ones(i.shape[:2], np.float32)}, name='depth'), lambda i: Part(rgb(i), name='photo'))),
    Row('one window for all', right(CLEAN, truth=normals()[2:34, 2:42]), pictures(
        '.exr', lambda p, i, k: window(p, i, k, 0))),
    Row('windows at other places', refused(65, 'window'), pictures('.exr', lambda p, i, k: window(p, i, k, 1))),
    Row('beyond what is displayed', right(CLEAN), of(rgb, origin=(-4, -4), display=(0, 0, 40, 32))),
    Row('chromaticities of Rec. 709', right(CLEAN, 'chromaticities'), of(rgb, more=chromaticities(*REC709))),
    Row('chromaticities of ACES', right(CLEAN), of(rgb, more=chromaticities(*ACES))),
    Row('compressed by ZIPS', right(CLEAN), of(rgb, zips=True)),
    Row('tiles', right(CLEAN), of(rgb, tile=16)),
    Row('values up to 100000', right(CLEAN), of(lambda i: rgb(i * 1e5))),
    Row('values of a millionth', right(CLEAN), of(lambda i: rgb(i * 1e-6))),
    Row('negative values', right(0.4), of(lambda i: rgb(i - 0.0005))),
    Row('not a number', refused(65, '04.exr', 'not a number|nan'), of(spoilt(np.nan), only=[3])),
    Row('infinity', refused(65, '04.exr', 'infinit'), of(spoilt(np.inf), only=[3])),
    Row('minus infinity', refused(65, '04.exr', 'infinit'), of(spoilt(-np.inf), only=[3])),
    Row('not a number in blue', refused(65, '04.exr', 'not a number|nan'), of(spoilt(np.nan, 'B'), only=[3])),
    Row('clipped at 1', said('clip|full', within=3), pictures(
        '.exr', lambda p, i, k: exr(p, Part(rgb(np.minimum(1.6 * i, 1)))))),
    Row('cut in half', refused(65, '08.exr'), then(of(rgb), lambda d: cut(d / '08.exr', 0.5))),
    Row('without its last row', refused(65, '08.exr'), then(of(rgb), lambda d: cut(d / '08.exr', 0.99))),
    Row('an empty file', refused(65, '08.exr', 'empty'), then(of(rgb), lambda d: cut(d / '08.exr', 0))),
    Row('an unknown version', refused(65, '08.exr'), then(of(rgb), lambda d: (d / '08.exr').write_bytes(
        b'v/1\x01' + struct.pack('<I', 9) + (d / '08.exr').read_bytes()[8:]))),
    Row('a window of the whole earth', refused(65, '08.exr'), then(of(rgb), lambda d: (d / '08.exr').write_bytes(
        (d / '08.exr').read_bytes().replace(struct.pack('<4i', 0, 0, 47, 39), struct.pack('<4i', 0, 0, 2**30, 2**30))))),
    Row('attributes of a camera', right(CLEAN), of(rgb, more=attribute('expTime', 'float', struct.pack('<f', 0.01)) +
                                                   attribute('owner', 'string', b'nobody'))),
]
