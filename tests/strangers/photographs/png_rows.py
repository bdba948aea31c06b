# SPDX-License-Identifier: Apache-2.0
"""PNG: depths, kinds, palettes, what its chunks say of light, files that end too early or too late."""
import struct
import numpy as np
import icc
from folder import jpeg_bytes, pictures, stored, then
from png import chunk, gamma, png, profile
from row import Row, refused, right, said
from scene import srgb, u8, u16

CLEAN, EIGHT, GREY = 0.3, 0.8, 0.6


def of(change, bits=None, kind=None, **more):
    """change(image) gives the samples."""
    return pictures('.png', lambda path, image, k: png(path, change(image), bits, kind, **more))


def grey(image):
    return image.mean(2)


def with_alpha(samples, value):
    samples = np.atleast_3d(samples)
    return np.dstack([samples, np.full(samples.shape[:2], value, samples.dtype)])


def palette(path, image, k, bits=8):
    """The photograph's greys, by a palette that is out of order."""
    top = 2 ** bits - 1
    order = np.random.default_rng(3).permutation(top + 1)
    level = np.round(srgb(grey(image)) * top).astype(int)
    table = np.zeros(top + 1, int)
    table[order] = np.round(np.arange(top + 1) * 255 / top)
    png(path, order[level].astype(np.uint8), bits, 3, [(b'PLTE', np.repeat(table, 3).astype(np.uint8).tobytes())])


def cut(path, share):
    path.write_bytes(path.read_bytes()[:int(share * path.stat().st_size)])


def broken(path):
    data = bytearray(path.read_bytes())
    data[data.index(b'IDAT') + 40] ^= 0x55
    path.write_bytes(data)


def cicp(transfer, primaries=1):
    return b'cICP', bytes([primaries, transfer, 0, 1])


def exif(value):
    return b'eXIf', b'MM\0*' + struct.pack('>IHHHIHHI', 8, 1, 274, 3, 1, value, 0, 0)


def turned(value):
    return pictures('.png', lambda path, image, k: png(path, u16(stored(image, value)), chunks=[exif(value)]))


def animated(path, image, k):
    rest = struct.pack('>IIIIIHHBB', 0, *image.shape[1::-1], 0, 0, 1, 10, 0, 0)
    png(path, u8(srgb(image)), chunks=[(b'acTL', struct.pack('>II', 1, 0)), (b'fcTL', rest)])


SIXTEEN = lambda image: u16(image)
CURVED = lambda image: u16(srgb(image))
RGB8 = lambda image: u8(srgb(image))
GAMMA2 = lambda image: u16(np.clip(image, 0, 1) ** 0.5)

ROWS = [
    Row('8 bits', right(EIGHT, '8 bits', 'srgb'), of(RGB8)),
    Row('16 bits', right(CLEAN, '16 bits', 'linear'), of(SIXTEEN)),
    Row('8 bits, grey', right(EIGHT), of(lambda i: u8(srgb(grey(i))))),
    Row('16 bits, grey', right(CLEAN), of(lambda i: u16(grey(i)))),
    Row('8 bits, grey and alpha', right(EIGHT), of(lambda i: with_alpha(u8(srgb(grey(i))), 255))),
    Row('8 bits, alpha', right(EIGHT), of(lambda i: with_alpha(RGB8(i), 255))),
    Row('16 bits, alpha', right(CLEAN), of(lambda i: with_alpha(u16(i), 65535))),
    Row('half transparent', right(EIGHT), of(lambda i: with_alpha(RGB8(i), 128))),
    Row('a palette of 256', right(EIGHT), pictures('.png', palette)),
    Row('a palette of 16', right(8), pictures('.png', lambda p, i, k: palette(p, i, k, 4))),
    Row('1 bit', refused(65, 'nothing was solved', 'full'), of(lambda i: (srgb(grey(i)) > 0.6).astype(np.uint8), 1, 0)),
    Row('2 bits, grey', said('residual|deviate|highlights', within=25), of(lambda i: np.round(srgb(grey(1.6 * i)) * 3).astype(np.uint8), 2, 0)),
    Row('4 bits, grey', right(8), of(lambda i: np.round(srgb(grey(i)) * 15).astype(np.uint8), 4, 0)),
    Row('interlaced, 8 bits', right(EIGHT), of(RGB8, interlaced=True)),
    Row('interlaced, 16 bits', right(CLEAN), of(SIXTEEN, interlaced=True)),
    Row('a transparent colour', right(EIGHT), of(RGB8, chunks=[(b'tRNS', struct.pack('>3H', 1, 2, 3))])),
    Row('16 bits that say sRGB', right(CLEAN, 'srgb', 'chunk'), of(CURVED, chunks=[(b'sRGB', b'\0')])),
    Row('16 bits of gamma 1/2.2', right(CLEAN, 'srgb', 'gama'), of(CURVED, chunks=[gamma(0.45455)])),
    Row('16 bits of gamma 1', right(CLEAN, 'linear', 'gama'), of(SIXTEEN, chunks=[gamma(1)])),
    Row('8 bits of gamma 1', right(1.2, 'linear', 'gama'), of(u8, chunks=[gamma(1)])),
    Row('16 bits of gamma 1/2', refused(65, 'curve', '--transfer'), of(GAMMA2, chunks=[gamma(0.5)])),
    Row('16 bits of gamma 0', right(CLEAN), of(SIXTEEN, chunks=[gamma(0)])),
    Row('cICP of sRGB', right(CLEAN, 'srgb', 'cicp'), of(CURVED, chunks=[cicp(13)])),
    Row('cICP linear', right(CLEAN, 'linear', 'cicp'), of(SIXTEEN, chunks=[cicp(8)])),
    Row('cICP of PQ', refused(65, 'curve', '--transfer'), of(SIXTEEN, chunks=[cicp(16, 9)])),
    Row('cICP of HLG', refused(65, 'curve', '--transfer'), of(SIXTEEN, chunks=[cicp(18, 9)])),
    Row('a linear profile, 8 bits', right(1.2, 'linear', 'profile'), of(u8, chunks=[profile(icc.LINEAR)])),
    Row('a profile of sRGB, 16 bits', right(CLEAN, 'srgb', 'profile'), of(CURVED, chunks=[profile(icc.SRGB)])),
    Row('a profile of Adobe RGB, 16 bits', right(CLEAN, 'profile'),
        of(lambda i: u16(np.clip(i, 0, 1) ** (1 / 2.19921875)), chunks=[profile(icc.ADOBE)])),
    Row('a grey profile of gamma 2.2', right(CLEAN, 'profile'),
        of(lambda i: u16(grey(i) ** (1 / 2.2)), chunks=[profile(icc.GREY_22)])),
    Row('a profile that is cut', right(EIGHT), of(RGB8, chunks=[profile(icc.SRGB[:200])])),
    Row('a profile of nonsense', right(EIGHT), of(RGB8, chunks=[profile(b'none' * 40)])),
    Row('profile and gamma disagree', right(CLEAN, 'profile'), of(CURVED, chunks=[gamma(1), profile(icc.SRGB)])),
    *[Row(f'orientation {value}', right(CLEAN, *(['orientation'] if value > 1 else [])), turned(value))
      for value in range(1, 9)],
    Row('orientation 0', right(CLEAN), of(SIXTEEN, chunks=[exif(0)])),
    Row('orientation 9', right(CLEAN), of(SIXTEEN, chunks=[exif(9)])),
    Row('one of them is turned', refused(65, 'orientation'), pictures(
        '.png', lambda p, i, k: png(p, u16(stored(i, 3)), chunks=[exif(3)]), only=[4])),
    Row('bytes behind the end', right(EIGHT), of(RGB8, behind=b'\0\0')),
    Row('another picture behind the end', right(EIGHT), pictures(
        '.png', lambda p, i, k: png(p, RGB8(i), behind=jpeg_bytes(i[::-1])))),
    Row('12 bits in 16', right(CLEAN), of(lambda i: u16(i, 4095), chunks=[(b'sBIT', b'\x0c\x0c\x0c')])),
    Row('animated, of one frame', right(EIGHT), pictures('.png', animated)),
    Row('texts, time and size', right(EIGHT), of(RGB8, chunks=[
        (b'pHYs', struct.pack('>IIB', 1, 2, 0)), (b'tIME', b'\7\xe8\1\1\0\0\0'), (b'tEXt', b'Title\0' + b'x' * 3000)])),
    Row('an unknown chunk that must be known', refused(65, '04.png'), pictures(
        '.png', lambda p, i, k: png(p, RGB8(i), chunks=[(b'WEFT', b'1')]), only=[3])),
    Row('cut in half', refused(65, '04.png'), then(of(SIXTEEN), lambda d: cut(d / '04.png', 0.5))),
    Row('without its end', refused(65, '04.png'), then(of(SIXTEEN), lambda d: cut(d / '04.png', 0.995))),
    Row('a byte is wrong', refused(65, '07.png'), then(of(SIXTEEN), lambda d: broken(d / '07.png'))),
    Row('an empty file', refused(65, '02.png', 'empty'), then(of(SIXTEEN), lambda d: cut(d / '02.png', 0))),
    Row('a header alone', refused(65, '02.png'), then(of(SIXTEEN), lambda d: cut(d / '02.png', 0.005))),
    Row('zeros after the header', refused(65, '09.png'), then(of(SIXTEEN), lambda d: (d / '09.png').write_bytes(
        (d / '09.png').read_bytes()[:60].ljust(9000, b'\0')))),
    Row('a size of nothing', refused(65, '01.png'), then(of(SIXTEEN), lambda d: (d / '01.png').write_bytes(
        b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 0, 40, 8, 2, 0, 0, 0)) + chunk(b'IEND')))),
    Row('a header of two billion pixels a side', refused(65, '01.png'), then(of(SIXTEEN), lambda d: (d / '01.png').write_bytes(
        b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 2**31 - 1, 2**31 - 1, 16, 6, 0, 0, 0)) +
        chunk(b'IDAT') + chunk(b'IEND')))),
]
