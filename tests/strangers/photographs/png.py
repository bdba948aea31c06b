# SPDX-License-Identifier: Apache-2.0
"""PNG files with any header: bit depths, colour types, chunks that contradict, bytes behind the end."""
import struct
import zlib
import numpy as np

ADAM7 = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]
KIND_OF = {1: 0, 2: 4, 3: 2, 4: 6}


def chunk(name, data=b''):
    return struct.pack('>I', len(data)) + name + data + struct.pack('>I', zlib.crc32(name + data))


def rows_of(samples, bits):
    """Filtered rows (filter 0) of samples (h, w, c)."""
    lines = []
    for row in samples:
        flat = row.reshape(-1)
        if bits == 16:
            line = flat.astype('>u2').tobytes()
        elif bits == 8:
            line = flat.astype(np.uint8).tobytes()
        else:
            apart = (flat[:, None].astype(int) >> np.arange(bits - 1, -1, -1)) & 1
            line = np.packbits(apart.astype(np.uint8).reshape(-1)).tobytes()
        lines.append(b'\0' + line)
    return b''.join(lines)


def png(path, samples, bits=None, kind=None, chunks=(), interlaced=False, behind=b''):
    samples = np.atleast_3d(samples)
    height, width, count = samples.shape
    bits = bits or samples.dtype.itemsize * 8
    kind = KIND_OF[count] if kind is None else kind
    data = rows_of(samples, bits)
    if interlaced:
        passes = [samples[y::down, x::right] for x, y, right, down in ADAM7]
        data = b''.join(rows_of(part, bits) for part in passes if part.size)
    head = struct.pack('>IIBBBBB', width, height, bits, kind, 0, 0, int(interlaced))
    path.write_bytes(b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', head) + b''.join(chunk(*each) for each in chunks) +
                     chunk(b'IDAT', zlib.compress(data)) + chunk(b'IEND') + behind)


def gamma(value):
    return b'gAMA', struct.pack('>I', round(value * 100000))


def profile(data):
    return b'iCCP', b'profile\0\0' + zlib.compress(data)
