# SPDX-License-Identifier: Apache-2.0
"""TIFF: sample forms, colour spaces, layouts, pages, profiles and what a scanner or a camera adds."""
import struct
import numpy as np
import icc
from folder import IMAGES, LIGHTS, pictures, stored, then
from png_rows import CLEAN, EIGHT, RGB8, cut, grey, with_alpha
from row import Row, refused, right, said
from scene import srgb, u8, u16
from tiff import DEFLATE, LZW, PACKBITS, Page, orientation, tiff


def of(change, big_endian=False, big=False, **more):
    return pictures('.tif', lambda path, image, k: tiff(path, Page(change(image), **more), big_endian=big_endian, big=big))


def pages(*made, only=None):
    return pictures('.tif', lambda path, image, k: tiff(path, *[each(image) for each in made]), only=only)


def small(image, **more):
    return Page(u8(srgb(image[::4, ::4])), **more)


def inks(image):
    """CMYK without black."""
    return u8(1 - srgb(image))


def ink_page(image):
    return np.dstack([inks(image), np.zeros(image.shape[:2], np.uint8)])


def lab(image):
    """Greys alone: L by CIE 1976, a and b 0."""
    y = np.clip(grey(image), 0, 1)
    light = np.where(y > 216 / 24389, 116 * np.cbrt(y) - 16, y * 24389 / 27)
    flat = np.zeros(y.shape, np.uint8)
    return np.dstack([np.round(light * 2.55).astype(np.uint8), flat, flat])


def mosaic(image):
    bayer = image[..., 1].copy()
    bayer[0::2, 0::2], bayer[1::2, 1::2] = image[0::2, 0::2, 0], image[1::2, 1::2, 2]
    return u16(bayer)


def palette(path, image, k):
    ramp = [round(v * 65535 / 255) for v in range(256)]
    tiff(path, Page(u8(srgb(grey(image))), photometric=3, tags=[(320, 3, ramp * 3)]))


def profiled(data, change):
    return of(change, tags=[(34675, 7, data)])


def exposed(change):
    """Every second one for half as long, as EXIF says."""
    def write(path, image, k):
        time = (1, 60) if k % 2 else (1, 30)
        tiff(path, Page(u16(change(image) / (1 + k % 2)), tags=[(33434, 5, [time]), (33437, 5, [(8, 1)]), (34855, 3, [100])]))
    return pictures('.tif', write)


def link_to_itself(path):
    data = bytearray(path.read_bytes())
    first, = struct.unpack_from('<I', data, 4)
    count, = struct.unpack_from('<H', data, first)
    struct.pack_into('<I', data, first + 2 + 12 * count, first)
    path.write_bytes(data)


def pointed_behind_its_end(path):
    data = bytearray(path.read_bytes())
    struct.pack_into('<I', data, 4, 1 << 30)
    path.write_bytes(data)


SIXTEEN = lambda image: u16(image)
FLOAT = lambda image: image.astype(np.float32)
TWELVE = lambda image: u16(image, 4095)
ADOBE16 = lambda image: u16(np.clip(image, 0, 1) ** (1 / 2.19921875))
REDUCED, THUMBNAIL = (254, 4, [1]), (255, 3, [2])

ROWS = [
    Row('8 bits', right(EIGHT, 'srgb'), of(RGB8)),
    Row('16 bits', right(CLEAN, 'linear'), of(SIXTEEN)),
    Row('8 bits, grey', right(EIGHT), of(lambda i: u8(srgb(grey(i))))),
    Row('16 bits, grey', right(CLEAN), of(lambda i: u16(grey(i)))),
    Row('floats', right(CLEAN), of(FLOAT)),
    Row('floats from 0 to 255', right(CLEAN), of(lambda i: FLOAT(i * 255))),
    Row('floats from 0 to 65535', right(CLEAN), of(lambda i: FLOAT(i * 65535))),
    Row('floats of a millionth', right(CLEAN), of(lambda i: FLOAT(i * 1e-6))),
    Row('halves', right(CLEAN), of(lambda i: i.astype(np.float16))),
    Row('doubles', right(CLEAN), of(lambda i: i.astype(np.float64))),
    Row('32 bits', right(CLEAN), of(lambda i: np.round(np.clip(i, 0, 1) * (2**32 - 1)).astype(np.uint32))),
    Row('signed 16 bits', right(CLEAN), of(lambda i: u16(i, 32767).astype(np.int16))),
    Row('signed 8 bits', right(2), of(lambda i: (RGB8(i) // 2).astype(np.int8))),
    Row('complex floats', refused(65, '01.tif'), of(lambda i: FLOAT(grey(i)), form=6, bits=64)),
    Row('10 bits', right(0.6), of(lambda i: u16(i, 1023), bits=10)),
    Row('12 bits', right(0.4), of(TWELVE, bits=12)),
    Row('14 bits', right(CLEAN), of(lambda i: u16(i, 16383), bits=14)),
    Row('4 bits, grey', right(8), of(lambda i: np.round(srgb(grey(i)) * 15).astype(np.uint8), bits=4)),
    Row('1 bit', refused(65, 'full|dark|one photograph'), of(lambda i: (srgb(grey(i)) > 0.6).astype(np.uint8), bits=1)),
    Row('min is white, 8 bits', right(EIGHT), of(lambda i: u8(1 - srgb(grey(i))), photometric=0)),
    Row('min is white, 16 bits', right(CLEAN), of(lambda i: u16(1 - grey(i)), photometric=0)),
    Row('a palette', right(EIGHT), pictures('.tif', palette)),
    Row('CMYK', right(1.0), of(ink_page, photometric=5)),
    Row('Lab', right(1.5), of(lab, photometric=8)),
    Row('a mosaic', refused(65, 'mosaic|bayer|raw'), of(mosaic, photometric=32803, tags=[
        (33421, 3, [2, 2]), (33422, 1, [0, 1, 1, 2])])),
    Row('grey that is called a mask', right(EIGHT), of(lambda i: RGB8(grey(i)), photometric=4)),
    Row('planes', right(CLEAN), of(SIXTEEN, planar=True)),
    Row('tiles', right(CLEAN), of(SIXTEEN, tile=16)),
    Row('tiles of planes', right(CLEAN), of(SIXTEEN, tile=32, planar=True)),
    Row('strips of three rows', right(CLEAN), of(SIXTEEN, rows=3)),
    Row('big-endian', right(CLEAN), of(SIXTEEN, big_endian=True)),
    Row('big-endian floats', right(CLEAN), of(FLOAT, big_endian=True)),
    Row('BigTIFF', right(CLEAN), of(SIXTEEN, big=True)),
    Row('big-endian BigTIFF in tiles', right(CLEAN), of(SIXTEEN, big=True, big_endian=True, tile=16)),
    Row('LZW', right(CLEAN), of(SIXTEEN, compression=LZW)),
    Row('LZW of differences', right(EIGHT), of(RGB8, compression=LZW, predictor=2)),
    Row('Deflate of differences', right(CLEAN), of(SIXTEEN, compression=DEFLATE, predictor=2)),
    Row('PackBits', right(EIGHT), of(RGB8, compression=PACKBITS)),
    Row('an unknown compression', refused(65, '01.tif'), of(RGB8, tags=[(259, 3, [34999])])),
    Row('alpha', right(CLEAN), of(lambda i: with_alpha(u16(i), 65535), extra=[2])),
    Row('alpha that is multiplied in', right(CLEAN), of(lambda i: with_alpha(u16(i), 65535), extra=[1])),
    Row('a fourth channel of nothing', right(CLEAN), of(lambda i: with_alpha(u16(i), 7), extra=[0])),
    Row('grey and alpha', right(CLEAN), of(lambda i: with_alpha(u16(grey(i)), 65535), extra=[2])),
    Row('five channels', refused(65, 'channel'), of(lambda i: with_alpha(with_alpha(u16(i), 1), 2), extra=[0, 0])),
    Row('two channels without a meaning', refused(65, 'channel'), of(
        lambda i: np.dstack([u16(grey(i)), u16(grey(i[::-1]))]), extra=[0])),
    Row('a preview first', right(CLEAN, 'page|thumbnail|passed over'), pages(lambda i: small(i), lambda i: Page(u16(i)))),
    Row('a preview last', right(CLEAN), pages(lambda i: Page(u16(i)), lambda i: small(i))),
    Row('a thumbnail first', right(CLEAN), pages(lambda i: small(i, tags=[REDUCED]), lambda i: Page(u16(i)))),
    Row('two pages alike', refused(65, 'page'), pages(lambda i: Page(u16(i)), lambda i: Page(u16(i[::-1])))),
    Row('all photographs as pages of one', refused(65, '10 lights', '1 photographs'), then(
        lambda d: tiff(d / 'all.tif', *[Page(u16(i)) for i in IMAGES]),
        lambda d: (d / 'lights.txt').write_text('\n'.join('%f %f %f' % tuple(v) for v in LIGHTS)))),
    *[Row(f'orientation {value}', right(CLEAN, *(['orientation'] if value > 1 else [])), pictures(
        '.tif', lambda p, i, k, value=value: tiff(p, Page(u16(stored(i, value)), tags=[orientation(value)]))))
      for value in range(1, 9)],
    Row('rows as stored, when asked', right(CLEAN, 'stored'), of(SIXTEEN, tags=[orientation(3)]),
        ('solve', '--photos', '.', '-o', 'out', '--no-previews', '--orientation', 'stored')),
    Row('a profile of sRGB, 16 bits', right(CLEAN, 'srgb', 'profile'), profiled(icc.SRGB, lambda i: u16(srgb(i)))),
    Row('a linear profile, 8 bits', right(1.2, 'linear', 'profile'), profiled(icc.LINEAR, u8)),
    Row('a profile of Adobe RGB', right(0.5, 'profile'), profiled(icc.ADOBE, ADOBE16)),
    Row('a profile that is cut', right(CLEAN), profiled(icc.SRGB[:150], SIXTEEN)),
    Row('exposures by turns', right(CLEAN, 'exposures differ'), exposed(lambda i: i)),
    Row('an unknown private tag', right(CLEAN), of(SIXTEEN, tags=[(65000, 7, b'x' * 5000)])),
    Row('a resolution of nothing', right(CLEAN), of(SIXTEEN, tags=[(282, 5, [(0, 0)]), (283, 5, [(1, 0)]), (296, 3, [2])])),
    Row('cut in half', refused(65, '06.tif'), then(of(SIXTEEN), lambda d: cut(d / '06.tif', 0.5))),
    Row('cut within its header', refused(65, '06.tif'), then(of(SIXTEEN), lambda d: cut(d / '06.tif', 0.999))),
    Row('an empty file', refused(65, '06.tif', 'empty'), then(of(SIXTEEN), lambda d: cut(d / '06.tif', 0))),
    Row('a page that follows itself', right(CLEAN), then(
        of(SIXTEEN), lambda d: link_to_itself(d / '04.tif'))),
    Row('a header behind its end', refused(65, '04.tif'), then(of(SIXTEEN), lambda d: pointed_behind_its_end(d / '04.tif'))),
    Row('one of a million pixels a side', refused(65, '05.tif', 'size'), pictures('.tif', lambda p, i, k: tiff(
        p, Page(u16(i), tags=[(256, 4, [1 << 20]), (257, 4, [1 << 20])])), only=[4])),
]
