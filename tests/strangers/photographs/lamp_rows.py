# SPDX-License-Identifier: Apache-2.0
"""Photographs that are not what they are taken for: axes of the lights, order, clipping, ambient light, near lamps."""
import numpy as np
import scene
from folder import COUNT, IMAGES, LIGHTS, jpeg, light_file, names, pictures, png8, png16, then
from png import png
from png_rows import CLEAN
from row import SOLVE, Row, refused, right, said
from scene import srgb, u8, u16

GLOSSY = scene.photographs(gloss=1.0)
RING = np.array([scene.lights(8, 50)[k] for k in range(0, 8, 2)])


def lit(change, write=png16, images=IMAGES, ending='.png'):
    """The lights as a file has them."""
    return pictures(ending, write, images, change(LIGHTS))


def with_images(images, write=png16, lights=LIGHTS):
    return pictures('.png', write, images, lights, files=names('.png')[:len(images)])


def numbered(files):
    """Lights and files as people count, the list in the order of their letters."""
    def make(folder):
        pictures('.png', png16, files=files, lamps=None)(folder)
        light_file(folder / 'lights.lp', sorted(files), LIGHTS)
    return make


def turned(degrees):
    a = np.radians(degrees)
    return lambda v: v @ np.array([[np.cos(a), np.sin(a), 0], [-np.sin(a), np.cos(a), 0], [0, 0, 1]])


def exchanged(k, m):
    order = list(range(COUNT))
    order[k], order[m] = m, k
    return order


def dark(folder):
    png(folder / 'lamps_off.png', u16(np.full((*IMAGES.shape[1:3], 3), 0.1)))


def near(distance):
    places = LIGHTS * distance
    return pictures('.png', png16, 0.6 * scene.photographs(near=places), places)


AMBIENT = IMAGES * 0.8 + 0.1
PIXELS = 48

ROWS = [
    Row('y points down', said('--flip'), lit(lambda v: v * [1, -1, 1])),
    Row('x points left', said('--flip'), lit(lambda v: v * [-1, 1, 1])),
    Row('y points down, and that is said', right(CLEAN), lit(lambda v: v * [1, -1, 1]), (*SOLVE, '--flip', 'y')),
    Row('x and y exchanged', said('--flip|mirrored'), lit(lambda v: v[:, [1, 0, 2]])),
    Row('turned by a quarter', said('--flip|turned'), lit(turned(90))),
    Row('all below the table', refused(65, 'below', '--flip'), lit(lambda v: v * [1, 1, -1])),
    Row('below the table, and that is said', right(CLEAN), lit(lambda v: v * [1, 1, -1]), (*SOLVE, '--flip', 'z')),
    Row('negated', refused(65, 'below', '--flip'), lit(lambda v: -v)),
    Row('one below the table', refused(65, 'below'), lit(lambda v: v * np.where(np.arange(COUNT) == 4, -1, 1)[:, None] ** [0, 0, 1])),
    Row('every second below the table', refused(65, 'below'), lit(lambda v: v * np.stack(
        [np.ones(COUNT), np.ones(COUNT), 1 - 2 * (np.arange(COUNT) % 2)], 1))),
    Row('on the table', refused(65, 'plane'), lit(lambda v: v * [1, 1, 0])),
    Row('all in one place', refused(65, 'plane|one direction|rank'), lit(lambda v: np.repeat(v[:1], COUNT, 0))),
    Row('all in one plane', refused(65, 'plane'), lit(lambda v: np.stack([np.cos(np.linspace(0.4, 2.7, COUNT)), np.zeros(COUNT),
                                                                          np.sin(np.linspace(0.4, 2.7, COUNT))], 1))),
    Row('names 1, 10, 2 under lights 1, 2, 3', said('order'), numbered([f'{k}.png' for k in range(1, 11)])),
    Row('two photographs exchanged', said('03.png|light 3|lights 3', '07.png|light 7|7'), with_images(IMAGES[exchanged(2, 6)])),
    Row('the lights in the other order', said('order'), lit(lambda v: v[::-1])),
    Row('one file under two lights', refused(65, '05.png', '02.png'), with_images(IMAGES[[0, 1, 2, 3, 1, 5, 6, 7, 8, 9]])),
    Row('the first one black', said('01.png|light 1|LED 1|dark'), with_images(np.concatenate([IMAGES[:1] * 0, IMAGES[1:]]))),
    Row('all black', refused(65, 'dark'), with_images(np.array([np.where(np.indices((40, 48, 3))[1] == k, 1e-4, 0) for k in range(COUNT)]))),
    Row('all white', refused(65, 'full'), with_images(np.array([1 - np.where(np.indices((40, 48, 3))[1] == k, 1e-4, 0) for k in range(COUNT)]))),
    Row('one of half the light', said('04.png|light 4|gain|deviate|50 percent'), with_images(
        IMAGES * np.where(np.arange(COUNT) == 3, 0.5, 1)[:, None, None, None])),
    Row('each scaled to its own maximum', said('light|gain|deviate|fit'), with_images(
        IMAGES / IMAGES.max((1, 2, 3), keepdims=True) * np.linspace(0.5, 0.95, COUNT)[:, None, None, None])),
    Row('an ambient light', said('--dark|--ambient'), with_images(AMBIENT)),
    Row('an ambient light that is said', right(0.4), with_images(AMBIENT), (*SOLVE, '--ambient', '0.1')),
    Row('a photograph of the dark', right(0.4), then(with_images(AMBIENT), dark), (*SOLVE, '--dark', 'lamps_off.png')),
    Row('a dark photograph of another size', refused(65, 'size', 'off.png'), then(with_images(AMBIENT), lambda d: png(
        d / 'off.png', u16(np.zeros((39, 48, 3))))), (*SOLVE, '--dark', 'off.png')),
    Row('a black level of four percent', said('--dark|--ambient'), with_images(IMAGES * 0.9 + 0.04)),
    Row('glossy', said('SATURATED', within=7), with_images(GLOSSY)),
    Row('clipped at 4095 in 16 bits', said('clipped|full', within=6), with_images(GLOSSY, lambda p, i, k: png(p, u16(1.4 * i, 4095)))),
    Row('clipped at 16383 in 16 bits', said('clipped|full', within=6), with_images(GLOSSY, lambda p, i, k: png(p, u16(1.4 * i, 16383)))),
    Row('overexposed by a stop', said('SATURATED', within=8), with_images(2 * IMAGES)),
    Row('underexposed to sixteen counts', right(3), with_images(IMAGES / 14, lambda p, i, k: png(p, u8(i)))),
    Row('linear values of 8 bits', said('linear', within=2), with_images(IMAGES, lambda p, i, k: png(p, u8(i)))),
    Row('curved values of 16 bits', said('srgb|curve|--transfer', within=2), with_images(IMAGES, lambda p, i, k: png(p, u16(srgb(i))))),
    Row('curved values, and that is said', right(CLEAN), with_images(IMAGES, lambda p, i, k: png(p, u16(srgb(i)))), (*SOLVE, '--transfer', 'srgb')),
    Row('lamps at three widths, as directions', said('taken as positions'), near(3 * PIXELS)),
    Row('lamps at three widths, in millimetres', right(1, 'near lights'), near(3 * PIXELS), (*SOLVE, '--mm-per-pixel', '1')),
    Row('four lights', right(1.5), with_images(IMAGES[[0, 1, 4, 7]], lights=LIGHTS[[0, 1, 4, 7]])),
    Row('three lights', right(3), with_images(IMAGES[[0, 3, 7]], lights=LIGHTS[[0, 3, 7]])),
    Row('two lights', refused(65, 'too few'), with_images(IMAGES[:2], lights=LIGHTS[:2])),
    Row('four lights of one height', right(2), with_images(scene.photographs(RING), lights=RING)),
    Row('sixty lights', right(CLEAN), pictures('.png', png16, scene.photographs(scene.lights(60)), scene.lights(60), files=[
        f'{k:03}.png' for k in range(60)])),
    Row('lights chosen by number', right(0.5), with_images(IMAGES), (*SOLVE, '--lights', '1,3,4,6,9')),
    Row('a light beyond the last', refused(64, '11', '10'), with_images(IMAGES), (*SOLVE, '--lights', '1,2,11')),
    Row('a flat grey card', right(CLEAN, truth=np.broadcast_to([0, 0, 1.0], (40, 48, 3))), with_images(
        0.5 * np.broadcast_to(LIGHTS[:, 2, None, None, None], IMAGES.shape) + 0.002 * np.random.default_rng(1).standard_normal(IMAGES.shape))),
]
