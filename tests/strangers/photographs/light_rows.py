# SPDX-License-Identifier: Apache-2.0
"""Light files of RTI (.lp) as people write them, and names as they come from other machines."""
import numpy as np
from folder import COUNT, LIGHTS, light_file, names, pictures, png16, then
from png_rows import CLEAN
from row import SOLVE, Row, refused, right, said, runs

NAMES = names('.png')
PLAIN = pictures('.png', png16, lamps=None)
SKIP = (*SOLVE, '--skip-missing')
ALL = list(range(COUNT))


def lp(write, run=SOLVE, name='lights.lp', files=None):
    """The photographs, and a light file that `write` gives as text or bytes."""
    def make(folder):
        pictures('.png', png16, lamps=None, files=files)(folder)
        data = write if isinstance(write, (bytes, str)) else write()
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(data if isinstance(data, bytes) else data.encode())
    return make


def lines(files=NAMES, lights=LIGHTS, form='{:.6f}', between=' ', count=COUNT, end='\n', more=None):
    rows = [] if count is None else [str(count)]
    for k, (name, toward) in enumerate(zip(files, lights)):
        rows.append(between.join([name, *map(form.format, toward), *([] if more is None else [str(more[k])])]))
    return end.join(rows) + end


def renamed(change):
    return lp(lambda: lines([change(n) for n in NAMES]))


def called(new, listed=None):
    """Photographs of these names, and a list of these."""
    return lp(lambda: lines(listed or new), files=new)


def spoilt(at, word):
    rows = lines().split('\n')
    rows[at] = word
    return '\n'.join(rows)


DECIMAL = lambda text: '\n'.join(row if k == 0 else ' '.join(
    [row.split(' ')[0], *[w.replace('.', ',') for w in row.split(' ')[1:]]]) for k, row in enumerate(text.split('\n')))
STRENGTHS = [1 + 0.05 * k for k in ALL]

ROWS = [
    Row('as RTI writes it', right(CLEAN), lp(lines)),
    Row('lines end as on Windows', right(CLEAN), lp(lambda: lines(end='\r\n'))),
    Row('lines end as on old machines', right(CLEAN), lp(lambda: lines(end='\r'))),
    Row('no end of the last line', right(CLEAN), lp(lambda: lines().rstrip('\n'))),
    Row('a byte order mark', right(CLEAN, 'byte order mark'), lp(lambda: b'\xef\xbb\xbf' + lines().encode())),
    Row('UTF-16', right(CLEAN, 'UTF-16'), lp(lambda: lines().encode('utf-16'))),
    Row('UTF-16 with the high byte first', right(CLEAN, 'UTF-16'), lp(lambda: b'\xfe\xff' + lines().encode('utf-16-be'))),
    Row('UTF-16 without a mark', right(CLEAN, 'UTF-16'), lp(lambda: lines().encode('utf-16-le'))),
    Row('UTF-32', refused(65, 'lights.lp'), lp(lambda: lines().encode('utf-32'))),
    Row('tabs', right(CLEAN), lp(lambda: lines(between='\t'))),
    Row('many blanks', right(CLEAN), lp(lambda: lines(between='    ').replace('\n', '  \n\n  '))),
    Row('commas', right(CLEAN), lp(lambda: lines(between=','))),
    Row('commas and blanks', right(CLEAN), lp(lambda: lines(between=', '))),
    Row('semicolons', right(CLEAN), lp(lambda: lines(between=';'))),
    Row('decimal commas', right(CLEAN, 'decimal commas'), lp(lambda: DECIMAL(lines()))),
    Row('decimal commas of positions', right(CLEAN, 'decimal commas', 'positions'), lp(
        lambda: DECIMAL(lines(lights=LIGHTS * 3.5)))),
    Row('decimal commas and semicolons', right(CLEAN, 'decimal commas'), lp(lambda: lines(between=';').replace('.', ',').replace(',png', '.png'))),
    Row('decimal commas and points', refused(65, 'line', 'lights.lp'), lp(lambda: spoilt(3, DECIMAL(lines()).split('\n')[3]))),
    Row('thousands parted by points', refused(65, 'line'), lp(lambda: spoilt(3, '03.png 1.000.000 2 3'))),
    Row('a comment first', right(CLEAN), lp(lambda: '# taken by anna\n' + lines())),
    Row('comments of other kinds', right(CLEAN), lp(lambda: '; a\n// b\n% c\n' + lines())),
    Row('blank lines first', right(CLEAN), lp(lambda: '\n\n \n' + lines())),
    Row('no count', right(CLEAN, 'no count'), lp(lambda: lines(count=None))),
    Row('a count too large', right(CLEAN, 'announces 12'), lp(lambda: lines(count=12))),
    Row('a count too small', right(CLEAN, 'announces 8'), lp(lambda: lines(count=8))),
    Row('a count below nothing', refused(65, 'number of photographs'), lp(lambda: lines(count=-1))),
    Row('a count that is a word', refused(65, 'number of photographs'), lp(lambda: lines(count='ten'))),
    Row('a count with a fraction', refused(65, 'number of photographs|line'), lp(lambda: lines(count='10.5'))),
    Row('nothing in it', refused(65, 'lights.lp', 'nothing'), lp('')),
    Row('a count alone', refused(65, 'lights.lp'), lp('10\n')),
    Row('zeros', refused(65, 'lights.lp', 'no text'), lp(b'\0' * 400)),
    Row('a picture under that name', refused(65, 'lights.lp', 'no text'), lp(lambda: b'\xff\xd8\xff\xe0' + bytes(range(256)))),
    Row('a line of two numbers', refused(65, 'line 4'), lp(lambda: spoilt(3, '03.png 0.1 0.2'))),
    Row('a line of five numbers', refused(65, 'line 4|numbers'), lp(lambda: spoilt(3, '03.png 0.1 0.2 0.3 1 1'))),
    Row('a word for a number', refused(65, 'line 4', 'left'), lp(lambda: spoilt(3, '03.png 0.1 left 0.3'))),
    Row('nan', refused(65, 'line 4', 'nan'), lp(lambda: spoilt(3, '03.png nan 0.2 0.9'))),
    Row('inf', refused(65, 'line 4', 'inf'), lp(lambda: spoilt(3, '03.png inf 0.2 0.9'))),
    Row('1e400', refused(65, 'line 4', '1e400'), lp(lambda: spoilt(3, '03.png 1e400 0.2 0.9'))),
    Row('a direction of no length', refused(65, 'no length'), lp(lambda: spoilt(3, '03.png 0 0 0'))),
    Row('hexadecimal numbers', refused(65, 'line 4', '0x'), lp(lambda: spoilt(3, '03.png 0x1p-1 0.2 0.9'))),
    Row('a minus sign of typographers', refused(65, 'line 4'), lp(lambda: spoilt(3, '03.png \u22120.5 0.2 0.9'))),
    Row('four numbers that count', right(CLEAN, 'fourth'), lp(lambda: lines(more=ALL))),
    Row('four numbers of strength 1', right(CLEAN, 'fourth', 'strength'), lp(lambda: lines(more=[1] * COUNT))),
    Row('a strength of nothing', refused(65, 'intensity|strength'), lp(lambda: lines(more=[0] * COUNT))),
    Row('positions', right(CLEAN, 'positions'), lp(lambda: lines(lights=LIGHTS * 120))),
    Row('positions at other distances', right(CLEAN, 'positions'), lp(
        lambda: lines(lights=LIGHTS * (100 + 7 * np.arange(COUNT))[:, None]))),
    Row('directions of two digits', right(0.5), lp(lambda: lines(form='{:.2f}'))),
    Row('exponents', right(CLEAN), lp(lambda: lines(form='{:.6E}'))),
    Row('plus signs', right(CLEAN), lp(lambda: lines(form='{:+.6f}'))),
    Row('names in quotes', right(CLEAN), renamed(lambda n: f'"{n}"')),
    Row('names with blanks', right(CLEAN), called([f'my cloth {k}.png' for k in range(10, 20)])),
    Row('names with blanks, in quotes', right(CLEAN), called(
        [f'my cloth {k}.png' for k in range(10, 20)], [f'"my cloth {k}.png"' for k in range(10, 20)])),
    Row('names with umlauts', right(CLEAN), called([f'gr\u00fcn {k}.png' for k in range(10, 20)])),
    Row('names of Japan', right(CLEAN), called([f'\u7d79_{k}.png' for k in range(10, 20)])),
    Row('names with apostrophes and brackets', right(CLEAN), called([f"anna's [{k}] (1).png" for k in range(10, 20)])),
    Row('names that begin with a minus', right(CLEAN), called([f'-{k}.png' for k in range(10, 20)])),
    Row('names in capitals', right(CLEAN, 'capitals'), renamed(str.upper)),
    Row('another ending', right(CLEAN, 'ending'), renamed(lambda n: n.replace('.png', '.jpg'))),
    Row('no ending', right(CLEAN, 'ending'), called([f'img{k}.png' for k in range(10, 20)], [f'img{k}' for k in range(10, 20)])),
    Row('no ending, numbers alone', refused(65, 'line 1', 'it has 4'), renamed(lambda n: n.replace('.png', ''))),
    Row('paths of Windows', right(CLEAN, 'another folder'), renamed(lambda n: 'C:\\Users\\anna\\RTI\\jpeg-exports\\' + n)),
    Row('paths of another machine', right(CLEAN, 'another folder'), renamed(lambda n: '/anna/dome/' + n)),
    Row('paths upwards', right(CLEAN), renamed(lambda n: '../cloth/' + n)),
    Row('paths beside it', right(CLEAN), renamed(lambda n: './' + n)),
    Row('in assembly-files beside', right(CLEAN), lp(
        lambda: lines(['..\\jpeg-exports\\' + n for n in NAMES]), name='assembly-files/cloth.lp',
        files=['jpeg-exports/' + n for n in NAMES]), ('solve', '--lp', 'assembly-files/cloth.lp', '-o', 'out', '--no-previews')),
    Row('one photograph is missing', refused(66, '11.png', '--skip-missing'), lp(
        lambda: lines([*NAMES, '11.png'], [*LIGHTS, LIGHTS[0]], count=11))),
    Row('one is missing, and may be', right(0.4, 'left out', '11.png'), lp(
        lambda: lines([*NAMES, '11.png'], [*LIGHTS, LIGHTS[0]], count=11)), SKIP),
    Row('all are missing', refused(66, '10 of 10'), renamed(lambda n: 'no' + n)),
    Row('one name twice', refused(65, '04.png', 'lights 4 and 5'), lp(
        lambda: lines([n if k != 4 else NAMES[3] for k, n in enumerate(NAMES)]))),
    Row('one name twice in other capitals', refused(66, '04.PNG|not there'), lp(
        lambda: lines([n if k != 4 else '04.PNG' for k, n in enumerate(NAMES)]))),
    Row('fewer than there are photographs', right(0.4, '8 photographs'), lp(lambda: lines(NAMES[:8], LIGHTS[:8], count=8))),
    Row('three lights', right(4), lp(lambda: lines([NAMES[k] for k in (0, 3, 7)], LIGHTS[[0, 3, 7]], count=3))),
    Row('two lights', refused(65, 'too few', '2 photographs'), lp(lambda: lines(NAMES[:2], LIGHTS[:2], count=2))),
    Row('one light', refused(65, 'too few|first line'), lp(lambda: lines(NAMES[:1], LIGHTS[:1], count=1))),
    Row('a name that is a folder', refused(66, '04.png|not there'), then(lp(lines), lambda d: ((d / '04.png').unlink(), (d / '04.png').mkdir()))),
    Row('a name of a thousand letters', refused(66, 'not there'), lp(lambda: spoilt(3, 'x' * 1000 + '.png 0.1 0.2 0.9'))),
    Row('a name that is the folder', refused(66, 'not there'), lp(lambda: spoilt(3, '. 0.1 0.2 0.9'))),
    Row('a name of nothing', refused(65, 'line 4|name|lights'), lp(lambda: spoilt(3, '"" 0.1 0.2 0.9'))),
    Row('a light file that is a folder', refused(66, 'lights.lp|light file'), then(PLAIN, lambda d: (d / 'lights.lp').mkdir())),
    Row('no light file', refused(66, 'no light file', '--lp'), PLAIN),
    Row('two light files that agree', right(CLEAN), then(lp(lines), lambda d: light_file(d / 'again.lp', NAMES))),
    Row('two light files that do not', refused(65, 'several light files'), then(
        lp(lines), lambda d: light_file(d / 'again.lp', NAMES, LIGHTS[::-1]))),
    Row('lights shown', runs('10 lights', 'decimal commas', 'azimuth'), lp(lambda: DECIMAL(lines())), ('lights', '.')),
    Row('a named light file that is not there', refused(66, 'none.lp'), PLAIN, ('solve', '--lp', 'none.lp', '-o', 'out')),
]
