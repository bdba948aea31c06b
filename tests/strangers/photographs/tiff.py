# SPDX-License-Identifier: Apache-2.0
"""TIFF files of every layout: byte orders, BigTIFF, tiles, planes, odd bit depths, several pages."""
import struct
import zlib
import numpy as np

SIZES = {1: 1, 2: 1, 3: 2, 4: 4, 5: 8, 7: 1, 12: 8, 13: 4, 16: 8}
LETTERS = {1: 'B', 3: 'H', 4: 'I', 12: 'd', 13: 'I', 16: 'Q'}
NONE, LZW, DEFLATE, PACKBITS = 1, 5, 8, 32773


def lzw(data):
    """Codes of nine bits alone: the table is cleared before it would want ten."""
    bits = []
    for i in range(0, len(data), 250):
        bits += [256, *data[i:i + 250]]
    bits.append(257)
    apart = (np.array(bits)[:, None] >> np.arange(8, -1, -1)) & 1
    return np.packbits(apart.astype(np.uint8).reshape(-1)).tobytes()


def packbits(data):
    return b''.join(bytes([len(part) - 1]) + part for part in (data[i:i + 128] for i in range(0, len(data), 128)))


def packed(samples, bits, order):
    """Rows of samples, each filled up to a whole byte."""
    if bits in (8, 16, 32, 64):
        return samples.astype(samples.dtype.newbyteorder(order)).tobytes()
    lines = []
    for row in samples:
        apart = (row.reshape(-1)[:, None].astype(int) >> np.arange(bits - 1, -1, -1)) & 1
        lines.append(np.packbits(apart.astype(np.uint8).reshape(-1)).tobytes())
    return b''.join(lines)


def differences(samples):
    turned = samples.copy()
    turned[:, 1:] -= samples[:, :-1]
    return turned


class Page:
    def __init__(self, samples, photometric=None, bits=None, form=None, tile=0, rows=0, planar=False, compression=NONE,
                 predictor=1, tags=(), extra=()):
        self.samples = np.atleast_3d(samples)
        count = self.samples.shape[2]
        self.bits = bits or self.samples.dtype.itemsize * 8
        self.form = form or {'u': 1, 'i': 2, 'f': 3}[self.samples.dtype.kind]
        self.photometric = (2 if count >= 3 else 1) if photometric is None else photometric
        self.tile, self.rows, self.planar, self.compression = tile, rows or self.samples.shape[0], planar, compression
        self.predictor, self.tags, self.extra = predictor, list(tags), list(extra)

    def pieces(self):
        planes = [self.samples[..., c:c + 1] for c in range(self.samples.shape[2])] if self.planar else [self.samples]
        for plane in planes:
            height, width = plane.shape[:2]
            if not self.tile:
                yield from (plane[y:y + self.rows] for y in range(0, height, self.rows))
                continue
            for y in range(0, height, self.tile):
                for x in range(0, width, self.tile):
                    part = plane[y:y + self.tile, x:x + self.tile]
                    fill = [(0, self.tile - part.shape[0]), (0, self.tile - part.shape[1]), (0, 0)]
                    yield np.pad(part, fill, mode='edge')

    def data(self, order):
        for piece in self.pieces():
            raw = packed(differences(piece) if self.predictor == 2 else piece, self.bits, order)
            yield {NONE: bytes, LZW: lzw, DEFLATE: zlib.compress, PACKBITS: packbits}[self.compression](raw)


def tiff(path, *pages, big_endian=False, big=False):
    """tags of a page: (code, type, values); type 2 or 7: bytes."""
    order = '>' if big_endian else '<'
    wide = 'Q' if big else 'I'
    out = bytearray(b'MM' if big_endian else b'II')
    out += struct.pack(order + ('HHHQ' if big else 'HI'), *((43, 8, 0, 0) if big else (42, 0)))
    link = len(out) - (8 if big else 4)
    for page in [p if isinstance(p, Page) else Page(p) for p in pages]:
        offsets, counts = [], []
        for data in page.data(order):
            offsets.append(len(out))
            counts.append(len(data))
            out += data + b'\0' * (len(data) % 2)
        height, width, samples = page.samples.shape
        where = 4 if not big else 16
        entries = [(256, 4, [width]), (257, 4, [height]), (258, 3, [page.bits] * samples), (259, 3, [page.compression]),
                   (262, 3, [page.photometric]), (277, 3, [samples]), (284, 3, [2 if page.planar else 1]),
                   (339, 3, [page.form] * samples)]
        entries += ([(322, 4, [page.tile]), (323, 4, [page.tile]), (324, where, offsets), (325, where, counts)] if page.tile
                    else [(273, where, offsets), (278, 4, [page.rows]), (279, where, counts)])
        if page.predictor != 1:
            entries.append((317, 3, [page.predictor]))
        if page.extra:
            entries.append((338, 3, page.extra))
        given = {code for code, _, _ in page.tags}
        entries = sorted([e for e in entries if e[0] not in given] + page.tags, key=lambda e: e[0])
        fields = []
        for code, kind, values in entries:
            if kind in (2, 7):
                value, count = values, len(values)
            elif kind == 5:
                value, count = b''.join(struct.pack(order + 'II', *v) for v in values), len(values)
            else:
                value, count = struct.pack(f'{order}{len(values)}{LETTERS[kind]}', *values), len(values)
            if len(value) > (8 if big else 4):
                out += b'\0' * (len(out) % 2)
                place, value = len(out), value + b'\0' * (len(value) % 2)
                out += value
                value = struct.pack(order + wide, place)
            fields.append(struct.pack(f'{order}HH{wide}', code, kind, count) + value.ljust(8 if big else 4, b'\0'))
        out += b'\0' * (len(out) % 2)
        struct.pack_into(order + wide, out, link, len(out))
        out += struct.pack(order + ('Q' if big else 'H'), len(fields)) + b''.join(fields)
        link = len(out)
        out += struct.pack(order + wide, 0)
    path.write_bytes(out)


def orientation(value):
    return 274, 3, [value]
