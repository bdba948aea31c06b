# SPDX-License-Identifier: Apache-2.0
"""Folders of ten photographs and a light file."""
import io
import numpy as np
from PIL import Image
import png
import scene
import tiff
from scene import u8, u16, srgb

COUNT = 10
IMAGES = scene.photographs()
LIGHTS = scene.lights()


def names(ending, pattern='{:02}'):
    return [pattern.format(k + 1) + ending for k in range(COUNT)]


def light_file(path, files, lights=LIGHTS, form='{:.6f}', between=' ', count=None, end='\n', head=''):
    lines = [] if count == '' else [str(len(files) if count is None else count)]
    lines += [between.join([name, *map(form.format, toward)]) for name, toward in zip(files, lights)]
    path.write_bytes((head + end.join(lines) + end).encode())


def pictures(ending, write, images=IMAGES, lights=LIGHTS, files=None, lamps='lights.lp', only=None):
    """Fills a folder: write(path, image, k) makes each photograph; those beyond `only` are plain."""
    def make(folder):
        listed = files or names(ending)
        for k, name in enumerate(listed):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (write if only is None or k in only else PLAIN[ending])(folder / name, images[k], k)
        if lamps:
            light_file(folder / lamps, listed, lights)
    return make


def then(make, *steps):
    """The same, and then steps(folder)."""
    def made(folder):
        make(folder)
        for step in steps:
            step(folder)
    return made


def png16(path, image, k=0):
    png.png(path, u16(image))


def png8(path, image, k=0):
    png.png(path, u8(srgb(image)))


def tiff16(path, image, k=0):
    tiff.tiff(path, u16(image))


def jpeg(quality=97, mode='RGB', **more):
    def write(path, image, k=0):
        picture = Image.fromarray(u8(srgb(image)))
        picture.convert(mode).save(path, 'JPEG', quality=quality, **{'subsampling': 0, **more})
    return write


def jpeg_bytes(image, **more):
    held = io.BytesIO()
    Image.fromarray(u8(srgb(image))).save(held, 'JPEG', quality=97, subsampling=0, **more)
    return held.getvalue()


PLAIN = {'.png': png16, '.tif': tiff16, '.jpg': jpeg()}


def stored(image, orientation):
    """Rows as a file with this tag stores them, so that it is shown as `image`."""
    turned = {1: image, 2: image[:, ::-1], 3: image[::-1, ::-1], 4: image[::-1], 5: image.swapaxes(0, 1),
              6: np.rot90(image, 1), 7: image[::-1, ::-1].swapaxes(0, 1), 8: np.rot90(image, -1)}
    return np.ascontiguousarray(turned[orientation])
