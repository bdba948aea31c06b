# SPDX-License-Identifier: Apache-2.0
# pixels.py READER FILE...: what a reader takes a picture for, to standard output. A file is a line of JSON and then
# its texels as 32-bit floats, top row first: whole numbers over the largest of their type, floats as they are.
import json
import sys

import numpy


def by_pillow(file):
    from PIL import Image

    with Image.open(file) as picture:
        picture.load()
        if picture.mode in ('1', 'P'):
            picture = picture.convert('RGB')
        texels = numpy.asarray(picture)
    if texels.dtype == numpy.int32:
        texels = texels.astype(numpy.uint16)
    return texels, list('rgba' if texels.ndim == 3 else 'y')


def by_openimageio(file):
    import OpenImageIO

    as_stored = OpenImageIO.ImageSpec()
    as_stored.attribute('oiio:UnassociatedAlpha', 1)
    source = OpenImageIO.ImageInput.open(file, as_stored)
    if source is None:
        raise OSError(OpenImageIO.geterror())
    names = list(source.spec().channelnames)
    texels = source.read_image(0, 0, 0, len(names), source.spec().format)
    if texels is None:
        raise OSError(source.geterror() or 'no texels')
    source.close()
    return texels, names


def main(reader, files):
    out = sys.stdout.buffer
    for file in files:
        try:
            texels, names = {'pillow': by_pillow, 'openimageio': by_openimageio}[reader](file)
        except Exception as error:  # whatever a reader says of a broken file is its answer
            out.write(json.dumps({'error': f'{type(error).__name__}: {error}'}).encode() + b'\n')
            continue
        if texels.ndim == 2:
            texels = texels[:, :, None]
        bits = texels.dtype.itemsize * 8
        whole = numpy.issubdtype(texels.dtype, numpy.integer)
        values = texels.astype('<f4') / numpy.float32(2**bits - 1 if whole else 1)
        height, width, channels = values.shape
        facts = {'width': width, 'height': height, 'channels': channels, 'bits': bits, 'whole': bool(whole), 'names': names[:channels]}
        out.write(json.dumps(facts).encode() + b'\n' + values.tobytes())


main(sys.argv[1], sys.argv[2:])
