# SPDX-License-Identifier: Apache-2.0
"""JPEG: profiles, orientations and exposures of EXIF, other colour spaces, damage; and files of other types."""
import io
import struct
import numpy as np
from PIL import Image
import icc
from folder import jpeg, jpeg_bytes, pictures, png8, png16, stored, then, tiff16
from png_rows import CLEAN, EIGHT, cut
from row import Row, refused, right
from scene import srgb, u8

FINE = 1.2


def exif(orientation=1, time=None, iso=100, aperture=(8, 1)):
    """EXIF of a camera; `time` of the shutter, a fraction."""
    entries = [(274, 3, struct.pack('<HH', orientation, 0))]
    inner = [(0x829A, 5, time), (0x829D, 5, aperture), (0x8827, 3, iso)] if time else []
    place = 8 + 2 + 12 * (len(entries) + bool(inner)) + 4
    if inner:
        entries.append((0x8769, 4, struct.pack('<I', place)))
    out = b'II*\0' + struct.pack('<IH', 8, len(entries))
    out += b''.join(struct.pack('<HHI', code, kind, 1) + value for code, kind, value in entries) + b'\0' * 4
    if inner:
        behind, extra = place + 2 + 12 * len(inner) + 4, b''
        out += struct.pack('<H', len(inner))
        for code, kind, value in inner:
            if kind == 5:
                out += struct.pack('<HHII', code, kind, 1, behind + len(extra))
                extra += struct.pack('<II', *value)
            else:
                out += struct.pack('<HHIHH', code, kind, 1, value, 0)
        out += b'\0' * 4 + extra
    return b'Exif\0\0' + out


def exposed(say, scale):
    """say(k): arguments of exif(); scale(k): the light that it gathered."""
    return pictures('.jpg', lambda p, i, k: jpeg(exif=exif(**say(k)))(p, i * scale(k)))


def one(ending, write, say='.jpg'):
    """The fourth photograph is of another type, under that name."""
    def written(path, image, k):
        if k != 3:
            return jpeg()(path, image)
        path.write_bytes(write(image) if callable(write) else write)
    return pictures(ending, written)


def by_pillow(kind, **more):
    def data(image):
        held = io.BytesIO()
        Image.fromarray(u8(srgb(image))).save(held, kind, **more)
        return held.getvalue()
    return data


def broken(path):
    data = bytearray(path.read_bytes())
    for at in range(len(data) // 2, len(data) // 2 + 60):
        data[at] = 0x00
    path.write_bytes(data)


def two_pictures(path, image, k):
    """A preview behind the photograph, as cameras write."""
    path.write_bytes(jpeg_bytes(image) + jpeg_bytes(image[::4, ::4]))


ZIP = b'PK\3\4' + b'\0' * 60
HEIC = b'\0\0\0\x18ftypheic' + b'\0' * 200
HTML = b'<!DOCTYPE html><title>404 Not Found</title>' + b' ' * 200

ROWS = [
    Row('of fine quality', right(FINE, 'srgb'), pictures('.jpg', jpeg())),
    Row('of poor quality', right(4), pictures('.jpg', jpeg(60))),
    Row('grey', right(FINE), pictures('.jpg', jpeg(mode='L'))),
    Row('progressive', right(FINE), pictures('.jpg', jpeg(progressive=True))),
    Row('colours of half the size', right(FINE), pictures('.jpg', jpeg(subsampling=2))),
    Row('CMYK', right(2), pictures('.jpg', jpeg(mode='CMYK'))),
    Row('a profile of sRGB', right(FINE, 'srgb', 'profile'), pictures('.jpg', jpeg(icc_profile=icc.SRGB))),
    Row('a profile of Adobe RGB', right(FINE, 'profile'), pictures(
        '.jpg', lambda p, i, k: Image.fromarray(u8(np.clip(i, 0, 1) ** (1 / 2.19921875))).save(
            p, quality=97, subsampling=0, icc_profile=icc.ADOBE))),
    Row('a linear profile', refused(65, 'a JPEG is not linear'), pictures(
        '.jpg', lambda p, i, k: Image.fromarray(u8(i)).save(p, quality=98, subsampling=0, icc_profile=icc.LINEAR))),
    Row('a profile that is cut', right(FINE), pictures('.jpg', jpeg(icc_profile=icc.SRGB[:130]))),
    *[Row(f'orientation {value}', right(FINE, *(['orientation'] if value > 1 else [])), pictures(
        '.jpg', lambda p, i, k, value=value: jpeg(exif=exif(value))(p, stored(i, value)))) for value in range(1, 9)],
    Row('one of them is turned', refused(65, 'orientation', '05.jpg'), pictures(
        '.jpg', lambda p, i, k: jpeg(exif=exif(3))(p, stored(i, 3)), only=[4])),
    Row('one of them lies on its side', refused(65, 'orientation', '05.jpg'), pictures(
        '.jpg', lambda p, i, k: jpeg(exif=exif(6))(p, stored(i, 6)), only=[4])),
    Row('exposures by turns', right(2, 'exposures differ'), exposed(
        lambda k: {'time': (1, 60 if k % 2 else 30)}, lambda k: 0.5 if k % 2 else 1)),
    Row('speeds by turns', right(2, 'exposures differ'), exposed(
        lambda k: {'time': (1, 30), 'iso': 50 if k % 2 else 100}, lambda k: 0.5 if k % 2 else 1)),
    Row('apertures by turns', right(2, 'exposures differ'), exposed(
        lambda k: {'time': (1, 30), 'aperture': (16 if k % 2 else 8, 1)}, lambda k: 0.25 if k % 2 else 1)),
    Row('exposures that are alike', right(FINE), exposed(lambda k: {'time': (1, 30)}, lambda k: 1)),
    Row('an exposure of nothing', right(FINE), exposed(lambda k: {'time': (0, 30)}, lambda k: 1)),
    Row('an exposure over nothing', right(FINE), exposed(lambda k: {'time': (1, 0)}, lambda k: 1)),
    Row('an exposure of one alone', right(FINE), pictures(
        '.jpg', jpeg(exif=exif(time=(1, 30))), only=[2])),
    Row('EXIF of nonsense', right(FINE), pictures('.jpg', jpeg(exif=b'Exif\0\0II*\0\xff\xff\xff\x7f' + b'\xee' * 40))),
    Row('another picture behind the end', right(FINE), pictures('.jpg', two_pictures)),
    Row('cut in half', refused(65, '03.jpg'), then(pictures('.jpg', jpeg()), lambda d: cut(d / '03.jpg', 0.5))),
    Row('without its end', refused(65, '03.jpg'), then(pictures('.jpg', jpeg()), lambda d: cut(d / '03.jpg', 0.97))),
    Row('zeros in the middle', refused(65, '03.jpg'), then(pictures('.jpg', jpeg()), lambda d: broken(d / '03.jpg'))),
    Row('an empty file', refused(65, '03.jpg', 'empty'), then(pictures('.jpg', jpeg()), lambda d: cut(d / '03.jpg', 0))),
    Row('a PNG under that name', right(FINE, '9 of', '1 of'), one('.jpg', by_pillow('PNG'))),
    Row('a TIFF under that name', right(FINE, '9 of', '1 of'), one('.jpg', by_pillow('TIFF'))),
    Row('a WebP under that name', refused(65, '04.jpg', 'no EXR'), one('.jpg', by_pillow('WEBP', lossless=True))),
    Row('a BMP under that name', refused(65, '04.jpg', 'no EXR'), one('.jpg', by_pillow('BMP'))),
    Row('a GIF under that name', refused(65, '04.jpg', 'no EXR'), one('.jpg', by_pillow('GIF'))),
    Row('a HEIC under that name', refused(65, '04.jpg', 'no EXR|heic'), one('.jpg', HEIC)),
    Row('a page of the web under that name', refused(65, '04.jpg', 'no EXR'), one('.jpg', HTML)),
    Row('an archive under that name', refused(65, '04.jpg', 'no EXR'), one('.jpg', ZIP)),
    Row('JPEGs under names of PNG', right(FINE), pictures('.png', jpeg())),
    Row('PNGs under names of TIFF', right(CLEAN), pictures('.tif', png16)),
    Row('TIFFs under names of JPEG', right(CLEAN), pictures('.jpg', tiff16)),
    Row('a raw name for a JPEG', right(FINE), pictures('.dng', jpeg())),
    Row('names in capitals', right(CLEAN), pictures('.PNG', png16)),
    Row('mixed: one TIFF of 16 bits among PNGs of 8', right(EIGHT, '16 bits', '8 bits'), pictures(
        '.png', lambda p, i, k: (tiff16 if k == 0 else png8)(p, i, k))),
    Row('WebP by names of its own', refused(65, '01.webp', 'no EXR'), pictures(
        '.webp', lambda p, i, k: p.write_bytes(by_pillow('WEBP')(i)))),
]
