# SPDX-License-Identifier: Apache-2.0
"""ICC profiles (version 2, matrix and curves) of any gamma and primaries."""
import struct

SRGB_PRIMARIES = ((0.4361, 0.2225, 0.0139), (0.3851, 0.7169, 0.0971), (0.1431, 0.0606, 0.7141))
ADOBE_PRIMARIES = ((0.6097, 0.3111, 0.0195), (0.2053, 0.6257, 0.0609), (0.1492, 0.0632, 0.7446))


def fixed(value):
    return struct.pack('>i', round(value * 65536))


def srgb_curve(v):
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def curve(gamma):
    """A number, or a function from 0..1 to 0..1 as a table; 1: a curve without entries."""
    if callable(gamma):
        table = [round(gamma(i / 1023) * 65535) for i in range(1024)]
        return b'curv\0\0\0\0' + struct.pack(f'>I{len(table)}H', len(table), *table)
    if gamma == 1:
        return b'curv\0\0\0\0' + struct.pack('>I', 0)
    return b'curv\0\0\0\0' + struct.pack('>IH', 1, round(gamma * 256)) + b'\0\0'


def profile(gamma, primaries=SRGB_PRIMARIES, space=b'RGB ', name=b'made by a test'):
    text = b'desc\0\0\0\0' + struct.pack('>I', len(name) + 1) + name + b'\0' + b'\0' * 78
    xyz = lambda v: b'XYZ \0\0\0\0' + b''.join(map(fixed, v))
    tags = [(b'desc', text), (b'cprt', b'text\0\0\0\0none\0'), (b'wtpt', xyz((0.9642, 1.0, 0.8249)))]
    if space == b'GRAY':
        tags += [(b'kTRC', curve(gamma))]
    else:
        tags += [(key, xyz(v)) for key, v in zip((b'rXYZ', b'gXYZ', b'bXYZ'), primaries)]
        tags += [(key, curve(gamma)) for key in (b'rTRC', b'gTRC', b'bTRC')]
    at, table, data = 128 + 4 + 12 * len(tags), struct.pack('>I', len(tags)), b''
    for key, value in tags:
        value += b'\0' * (-len(value) % 4)
        table += key + struct.pack('>II', at + len(data), len(value))
        data += value
    head = struct.pack('>I4sI4s4s4s', 128 + len(table) + len(data), b'none', 0x02100000, b'mntr', space, b'XYZ ')
    head += struct.pack('>6H', 2024, 1, 1, 0, 0, 0) + b'acsp' + b'\0' * 28 + fixed(0.9642) + fixed(1) + fixed(0.8249)
    return head.ljust(128, b'\0') + table + data


SRGB = profile(srgb_curve, name=b'sRGB IEC61966-2.1')
LINEAR = profile(1, name=b'linear')
ADOBE = profile(2.19921875, ADOBE_PRIMARIES, name=b'Adobe RGB (1998)')
GREY_22 = profile(2.2, space=b'GRAY', name=b'Dot gain')
