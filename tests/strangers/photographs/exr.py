# SPDX-License-Identifier: Apache-2.0
"""EXR files of any channels, windows, parts and attributes, and the reader of weft's normals."""
import struct
import zlib
import numpy as np

KINDS = {'uint32': 0, 'float16': 1, 'float32': 2}


def attribute(name, kind, data):
    return name.encode() + b'\0' + kind.encode() + b'\0' + struct.pack('<i', len(data)) + data


def box(x, y, width, height):
    return struct.pack('<4i', x, y, x + width - 1, y + height - 1)


def squeezed(raw):
    """One row, as ZIPS has it: even bytes, odd bytes, differences."""
    row = np.frombuffer(raw, np.uint8)
    row = np.concatenate([row[::2], row[1::2]]).astype(int)
    row[1:] = np.diff(row) + 128
    packed = zlib.compress((row % 256).astype(np.uint8).tobytes())
    return packed if len(packed) < len(raw) else raw


class Part:
    """`channels`: {name: rows}; `sampling`: names of those with every second pixel of every second row."""

    def __init__(self, channels, origin=(0, 0), display=None, name=None, more=b'', zips=False, sampling=(), tile=0):
        self.channels = dict(sorted(channels.items()))
        whole = next(rows for each, rows in self.channels.items() if each not in sampling)
        self.height, self.width = whole.shape
        self.origin, self.name, self.more, self.zips, self.sampling, self.tile = origin, name, more, zips, sampling, tile
        self.display = display or (0, 0, self.width, self.height)

    def header(self, of_many):
        listed = b''.join(name.encode() + b'\0' + struct.pack('<iI2i', KINDS[rows.dtype.name], 0,
                                                             *([2, 2] if name in self.sampling else [1, 1]))
                          for name, rows in self.channels.items()) + b'\0'
        head = (attribute('channels', 'chlist', listed) + attribute('compression', 'compression', bytes([2 if self.zips else 0])) +
                attribute('dataWindow', 'box2i', box(*self.origin, self.width, self.height)) +
                attribute('displayWindow', 'box2i', box(*self.display)) + attribute('lineOrder', 'lineOrder', b'\0') +
                attribute('pixelAspectRatio', 'float', struct.pack('<f', 1)) +
                attribute('screenWindowCenter', 'v2f', struct.pack('<2f', 0, 0)) +
                attribute('screenWindowWidth', 'float', struct.pack('<f', 1)) + self.more)
        if self.tile:
            head += attribute('tiles', 'tiledesc', struct.pack('<IIB', self.tile, self.tile, 0))
        if of_many:
            head += (attribute('name', 'string', self.name.encode()) + attribute('type', 'string', b'scanlineimage') +
                     attribute('chunkCount', 'int', struct.pack('<i', self.height)))
        return head + b'\0'

    def chunks(self):
        if self.tile:
            for y in range(0, self.height, self.tile):
                for x in range(0, self.width, self.tile):
                    parts = {name: rows[y:y + self.tile, x:x + self.tile] for name, rows in self.channels.items()}
                    height = next(iter(parts.values())).shape[0]
                    data = b''.join(part[row].tobytes() for row in range(height) for part in parts.values())
                    yield struct.pack('<5i', x // self.tile, y // self.tile, 0, 0, len(data)) + data
            return
        for row in range(self.height):
            y = row + self.origin[1]
            lines = [rows[row // 2] if name in self.sampling else rows[row] for name, rows in self.channels.items()
                     if name not in self.sampling or y % 2 == 0]
            data = b''.join(line.tobytes() for line in lines)
            data = squeezed(data) if self.zips else data
            yield struct.pack('<2i', y, len(data)) + data


def exr(path, *parts):
    many = len(parts) > 1
    flags = 0x1000 if many else 0x200 if parts[0].tile else 0
    head = b'v/1\x01' + struct.pack('<I', 2 | flags) + b''.join(part.header(many) for part in parts)
    head = head[:4] + struct.pack('<I', 2 | flags) + head[8:] + (b'\0' if many else b'')
    all_chunks = [[(struct.pack('<i', k) if many else b'') + each for each in part.chunks()] for k, part in enumerate(parts)]
    at = len(head) + 8 * sum(map(len, all_chunks))
    table, data = b'', b''
    for chunks in all_chunks:
        for each in chunks:
            table += struct.pack('<Q', at + len(data))
            data += each
    path.write_bytes(head + table + data)


def rgb(image, kind=np.float32, names='RGB'):
    return {name: np.ascontiguousarray(image[..., c], dtype=kind) for c, name in enumerate(names)}


def chromaticities(*eight):
    return attribute('chromaticities', 'chromaticities', struct.pack('<8f', *eight))


def read_normals(path):
    """normal.exr of a solve: X, Y, Z as floats, uncompressed."""
    data = path.read_bytes()
    at, attributes = 8, {}
    while data[at]:
        name, kind, rest = data[at:].split(b'\0', 2)
        size, = struct.unpack_from('<i', rest)
        at += len(name) + len(kind) + 6
        attributes[name.decode()] = data[at:at + size]
        at += size
    left, top, right, bottom = struct.unpack('<4i', attributes['dataWindow'])
    width, height = right - left + 1, bottom - top + 1
    offsets = struct.unpack_from(f'<{height}Q', data, at + 1)
    assert attributes['compression'] == b'\0' and attributes['channels'].startswith(b'X\0\2'), path
    rows = [np.frombuffer(data, '<f4', 3 * width, offset + 8).reshape(3, width) for offset in offsets]
    return np.moveaxis(np.array(rows, dtype=float), 1, 2)
