# SPDX-License-Identifier: Apache-2.0
"""Layouts of data sets and programs: DiLiGenT, RelightLab, Meshroom, NumPy, MATLAB, tables with a heading."""
import io
import json
import numpy as np
from folder import COUNT, IMAGES, LIGHTS, light_file, names, pictures, png16, then
from png import png
from png_rows import CLEAN
from row import SOLVE, Row, refused, right, said
from scene import HEIGHT, WIDTH, normals, u16

NAMES = names('.png')
STRENGTHS = 0.5 + 0.05 * np.arange(COUNT)
COLOURED = np.stack([STRENGTHS, 1.1 * STRENGTHS, 0.9 * STRENGTHS], 1)
NAMED = '\n'.join(NAMES) + '\n'
MESHROOM = LIGHTS * [1, -1, -1]


def text(rows, form='%.7f', between=' '):
    held = io.StringIO()
    np.savetxt(held, np.atleast_2d(rows), fmt=form, delimiter=between)
    return held.getvalue()


def npy(array, **more):
    held = io.BytesIO()
    np.save(held, array, **more)
    return held.getvalue()


def holding(files, scaled=None, listed=NAMES, order=None):
    """Photographs and these files. `scaled`: the strength of each light, by which photographs are brighter."""
    images = IMAGES if scaled is None else IMAGES * np.reshape(scaled, (COUNT, 1, 1, -1))
    def make(folder):
        pictures('.png', png16, images if order is None else images[order], files=listed, lamps=None)(folder)
        for name, data in files.items():
            (folder / name).write_bytes(data if isinstance(data, bytes) else data.encode())
    return make


def diligent(directions=None, strengths=None, named=NAMED, scaled=None, **more):
    files = {'light_directions.txt': text(LIGHTS) if directions is None else directions}
    if strengths is not None:
        files['light_intensities.txt'] = strengths
    if named:
        files['filenames.txt'] = named
    return holding(files, scaled, **more)


def table(head, rows, between=','):
    return between.join(head) + '\n' + '\n'.join(between.join(map(str, row)) for row in rows) + '\n'


AZIMUTH = np.degrees(np.arctan2(LIGHTS[:, 1], LIGHTS[:, 0]))
ELEVATION = np.degrees(np.arcsin(LIGHTS[:, 2]))
POINTS = [dict(zip('xyz', map(float, toward))) for toward in LIGHTS]
HEADED = [(n, *v) for n, v in zip(NAMES, LIGHTS)]


def relight(skip=(), **dome):
    images = [{'filename': n, 'skip': k in skip} for k, n in enumerate(NAMES)]
    return json.dumps({'images': images, 'dome': {'lightConfiguration': 'directional', 'directions': POINTS, **dome}})


def meshroom(order=range(COUNT), view=lambda k: str(900 + k)):
    return json.dumps({'lights': [{'viewId': view(k), 'type': 'directional', 'intensity': ['1', '1', '1'],
                                   'direction': [f'{v:.7f}' for v in MESHROOM[k]]} for k in order]})


def sfm(path=lambda name: f'/anna/photos/{name}', count=COUNT, listed=NAMES):
    return json.dumps({'version': ['1', '2', '6'], 'views': [
        {'viewId': str(900 + k), 'path': path(n), 'width': str(WIDTH), 'height': str(HEIGHT)}
        for k, n in enumerate(listed[:count])]})


MIXED = [3, 1, 4, 0, 9, 2, 6, 5, 8, 7]
MASK = np.zeros((HEIGHT, WIDTH), np.uint8)
MASK[6:34, 8:40] = 255
INSIDE = MASK > 0


def masked(write):
    return then(diligent(), lambda d: write(d / 'mask.png'))


ROWS = [
    Row('DiLiGenT', right(CLEAN), diligent(strengths=text(COLOURED), scaled=COLOURED)),
    Row('one column of intensities', right(CLEAN), diligent(strengths=text(STRENGTHS[:, None]), scaled=STRENGTHS)),
    Row('one row of intensities', right(CLEAN, 'column'), diligent(strengths=text(STRENGTHS), scaled=STRENGTHS)),
    Row('no intensities', right(CLEAN), diligent()),
    Row('two columns of intensities', refused(65, 'light_intensities'), diligent(strengths=text(COLOURED[:, :2]))),
    Row('an intensity of nothing', refused(65, 'intensity'), diligent(strengths=text(COLOURED * (np.arange(COUNT) != 3)[:, None]))),
    Row('nine intensities of ten', refused(65, '9'), diligent(strengths=text(COLOURED[:9]))),
    Row('directions in three rows', right(CLEAN, 'column'), diligent(text(LIGHTS.T))),
    Row('directions by commas', right(CLEAN), diligent(text(LIGHTS, between=','))),
    Row('decimal commas', right(CLEAN, 'decimal commas'), diligent(text(LIGHTS).replace('.', ','))),
    Row('no names', right(CLEAN, 'order of their names'), diligent(named='')),
    Row('names and lines differ', refused(65, '9'), diligent(named='\n'.join(NAMES[:9]))),
    Row('names with a byte order mark', right(CLEAN), diligent(named='\ufeff' + NAMED)),
    Row('names with lines of Windows', right(CLEAN), diligent(named=NAMED.replace('\n', '\r\n'))),
    Row('names in another order', right(CLEAN), diligent(text(LIGHTS[::-1]), named='\n'.join(NAMES[::-1]))),
    Row('an array of NumPy', right(CLEAN), holding({'light_directions.npy': npy(LIGHTS), 'filenames.txt': NAMED})),
    Row('an array of NumPy on its side', right(CLEAN, 'column'), holding({'light_directions.npy': npy(LIGHTS.T)})),
    Row('an array in the order of Fortran', right(CLEAN), holding({'lights.npy': npy(np.asfortranarray(LIGHTS))})),
    Row('an array of floats', right(CLEAN), holding({'lights.npy': npy(LIGHTS.astype(np.float32))})),
    Row('an array of floats, big-endian', refused(65, '>f4'), holding({'lights.npy': npy(LIGHTS.astype('>f4'))})),
    Row('an array of objects', refused(65, 'lights.npy'), holding({'lights.npy': npy(LIGHTS.astype(object), allow_pickle=True)})),
    Row('an array with a NaN', refused(65, 'lights.npy', 'nan|number|finite'), holding({'lights.npy': npy(
        np.where(np.arange(COUNT)[:, None] == 4, np.nan, LIGHTS))})),
    Row('an array that is cut', refused(65, 'lights.npy'), holding({'lights.npy': npy(LIGHTS)[:150]})),
    Row('an array of three axes', refused(65, 'lights.npy'), holding({'lights.npy': npy(LIGHTS[None])})),
    Row('MATLAB, as text', right(CLEAN), holding({'lights.txt': text(LIGHTS, '  %.7e')})),
    Row('MATLAB, binary', refused(65, 'MATLAB', 'ascii'), holding({'lights.txt': b'MATLAB 5.0 MAT-file' + b'\0' * 200})),
    Row('MATLAB 7.3', refused(65, 'MATLAB'), holding({'lights.txt': b'\x89HDF\r\n\x1a\n' + b'\0' * 200})),
    Row('a list of directions', right(CLEAN, 'order of their names'), holding({'directions.txt': text(LIGHTS)})),
    Row('a list beside notes', right(CLEAN), holding({'lights.txt': text(LIGHTS), 'notes.txt': 'cloth of anna\n'})),
    Row('a table: file, x, y, z', right(CLEAN), holding({'lights.csv': table(['file', 'x', 'y', 'z'], HEADED)})),
    Row('a table in another order', right(CLEAN), holding({'lights.csv': table(
        ['Z', 'Filename', 'X', 'Y'], [(v[2], n, v[0], v[1]) for n, v in zip(NAMES, LIGHTS)])})),
    Row('a table with other columns', right(CLEAN, 'passed over'), holding({'lights.csv': table(
        ['file', 'x', 'y', 'z', 'taken'], [(*row, 'noon') for row in HEADED])})),
    Row('a table by semicolons', right(CLEAN, 'decimal commas'), holding({'lights.csv': table(
        ['file', 'x', 'y', 'z'], HEADED, ';').replace('.', ',').replace(',png', '.png')})),
    Row('azimuth and elevation', right(CLEAN, 'degrees'), holding({'lights.csv': table(
        ['file', 'azimuth', 'elevation'], zip(NAMES, AZIMUTH, ELEVATION))})),
    Row('azimuth and elevation in radians', refused(65, 'radians'), holding({'lights.csv': table(
        ['file', 'azimuth', 'elevation'], zip(NAMES, np.radians(AZIMUTH), np.radians(ELEVATION)))})),
    Row('a table with strengths', right(CLEAN), holding({'lights.csv': table(
        ['file', 'x', 'y', 'z', 'strength'], [(*row, s) for row, s in zip(HEADED, STRENGTHS)])}, STRENGTHS)),
    Row('a row with too many words', refused(65, 'line'), holding({'lights.csv': table(
        ['file', 'x', 'y', 'z'], [*HEADED[:9], (*HEADED[9], 1)])})),
    Row('a dome of RelightLab', right(CLEAN), holding({'cloth.dome': json.dumps(
        {'lightConfiguration': 'directional', 'directions': POINTS})})),
    Row('a dome of positions', right(CLEAN, 'positions'), holding({'cloth.dome': json.dumps(
        {'lightConfiguration': 'lights3d', 'positions3d': [dict(zip('xyz', map(float, 300 * v))) for v in LIGHTS]})})),
    Row('a project of RelightLab', right(CLEAN), holding({'cloth.relight': relight()})),
    Row('a project that skips two', right(0.4, 'left out'), holding({'cloth.relight': relight((2, 5))})),
    Row('a project with led adjustments', right(CLEAN, 'ledAdjust'), holding({'cloth.relight': relight(
        ledAdjust=[{'r': float(1 / s), 'g': float(1 / s), 'b': float(1 / s)} for s in STRENGTHS])}, STRENGTHS)),
    Row('a project that is cut', refused(65, 'cloth.relight'), holding({'cloth.relight': relight()[:300]})),
    Row('a dome of nine lights', refused(65, '9 lights'), holding({'cloth.dome': json.dumps({'directions': POINTS[:9]})})),
    Row('Meshroom', right(CLEAN, 'turned round'), holding({'lights.json': meshroom()})),
    Row('Meshroom, in the order of its views', right(CLEAN, 'cameraInit.sfm'), holding(
        {'lights.json': meshroom(MIXED), 'cameraInit.sfm': sfm()})),
    Row('Meshroom, names that count otherwise', right(CLEAN, 'cameraInit.sfm'), holding(
        {'lights.json': meshroom(), 'cameraInit.sfm': sfm(listed=[f'{v}.png' for v in range(31, 41)][::-1])},
        listed=[f'{v}.png' for v in range(31, 41)][::-1])),
    Row('Meshroom, paths of Windows', right(CLEAN, 'cameraInit.sfm'), holding(
        {'lights.json': meshroom(MIXED), 'cameraInit.sfm': sfm(lambda n: f'D:\\rti\\{n}')})),
    Row('Meshroom, views as numbers', right(CLEAN, 'cameraInit.sfm'), holding(
        {'lights.json': meshroom(MIXED, lambda k: 900 + k), 'cameraInit.sfm': sfm()})),
    Row('Meshroom, a .sfm of other views', right(CLEAN, 'no .sfm'), holding(
        {'lights.json': meshroom(), 'other.sfm': sfm(count=4)})),
    Row('Meshroom, two that differ', refused(65, 'a.sfm', 'b.sfm'), holding(
        {'lights.json': meshroom(), 'a.sfm': sfm(), 'b.sfm': sfm(listed=NAMES[::-1])})),
    Row('Meshroom, a .sfm that is cut', refused(65, 'a.sfm'), holding({'lights.json': meshroom(), 'a.sfm': sfm()[:99]})),
    Row('Meshroom, harmonics', refused(65, 'harmonics'), holding({'lights.json': json.dumps(
        {'lights': [{'direction': list(range(9))}] * COUNT})})),
    Row('JSON of something else', refused(66, 'no light file'), holding({'package.json': '{"name": "cloth"}'})),
    Row('JSON named by hand that is something else', refused(65, 'package.json'), holding(
        {'package.json': '{"name": "cloth"}'}), ('solve', '--photos', '.', '--lp', 'package.json', '-o', 'out')),
    Row('a mask', right(CLEAN, inside=INSIDE), masked(lambda p: png(p, MASK))),
    Row('a mask of zeros and ones', right(CLEAN, inside=INSIDE), masked(lambda p: png(p, MASK // 255))),
    Row('a mask of one bit', right(CLEAN, inside=INSIDE), masked(lambda p: png(p, MASK // 255, 1, 0))),
    Row('a mask of alpha', right(CLEAN, inside=INSIDE), masked(lambda p: png(p, np.dstack([MASK * 0 + 255, MASK])))),
    Row('a mask in capitals', right(CLEAN, inside=INSIDE), then(diligent(), lambda d: png(d / 'Mask.PNG', MASK))),
    Row('a black mask', refused(65, 'mask'), masked(lambda p: png(p, MASK * 0))),
    Row('a grey mask', refused(65, 'mask'), masked(lambda p: png(p, MASK // 3))),
    Row('a mask of another size', refused(65, 'mask', 'size'), masked(lambda p: png(p, MASK[1:]))),
    Row('a mask that is no picture', refused(65, 'mask.png'), masked(lambda p: p.write_text('white'))),
    Row('two masks', refused(65, 'several masks'), then(masked(lambda p: png(p, MASK)), lambda d: png(d / 'cloth_mask.png', MASK))),
]
