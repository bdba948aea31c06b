# SPDX-License-Identifier: Apache-2.0
"""A small Lambert surface under distant lights: photographs as floats, and the normals that are true of them."""
import numpy as np

WIDTH, HEIGHT = 48, 40


def lights(count=10, elevation=52.0):
    """Unit vectors: x to the right, y up, z to the camera. Every second one stands higher than the others."""
    azimuth = np.radians(11.0 + 360.0 / count * np.arange(count))
    height = np.radians(elevation + 11.0 * (np.arange(count) % 2))
    return np.stack([np.cos(azimuth) * np.cos(height), np.sin(azimuth) * np.cos(height), np.sin(height)], 1)


def slopes():
    """Of waves that run aslant, so that their mirror image is no surface."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH].astype(float)
    a, b, c = x / 4.1 + y / 6.3, y / 5.2 - x / 9.7, x / 8.3 + y / 3.9
    right = 0.30 * np.cos(a) - 0.14 * np.cos(b) + 0.12 * np.cos(c)
    down = 0.30 * np.cos(a) * 4.1 / 6.3 + 0.14 * np.cos(b) * 9.7 / 5.2 + 0.12 * np.cos(c) * 8.3 / 3.9
    return right, down


def normals():
    right, down = slopes()
    n = np.stack([-right, down, np.ones_like(right)], 2)
    return n / np.linalg.norm(n, axis=2, keepdims=True)


def albedo():
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    return np.stack([0.62 + 0.16 * (x // 8 % 2), 0.44 + 0.18 * (y // 7 % 2), 0.34 + 0.08 * np.sin(x / 6.0)], 2)


def photographs(directions=None, gloss=0.0, noise=0.002, near=None):
    """Linear photographs from 0 to 1 (n, h, w, 3). `near`: lamps at these places in pixels over the middle."""
    directions = lights() if directions is None else directions
    surface, colour, shots = normals(), albedo(), []
    scatter = np.random.default_rng(7)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    places = np.stack([x - (WIDTH - 1) / 2, (HEIGHT - 1) / 2 - y, np.zeros(x.shape)], 2)
    for k, toward in enumerate(directions):
        strength = 1.0
        if near is not None:
            way = near[k] - places
            distance = np.linalg.norm(way, axis=2, keepdims=True)
            toward, strength = way / distance, (np.linalg.norm(near[k]) / distance[..., 0]) ** 2
        shade = np.maximum((surface * toward).sum(2), 0) * strength
        half = toward + np.array([0, 0, 1.0])
        half = half / np.linalg.norm(half, axis=-1, keepdims=True)
        shine = gloss * np.maximum((surface * half).sum(2), 0) ** 60
        shots.append(0.95 * shade[..., None] * colour + shine[..., None])
    shots = np.array(shots)
    return np.maximum(shots + noise * scatter.standard_normal(shots.shape), 0)


def srgb(linear):
    v = np.clip(linear, 0, 1)
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)


def u8(values):
    return np.round(np.clip(values, 0, 1) * 255).astype(np.uint8)


def u16(values, top=65535):
    return np.round(np.clip(values, 0, 1) * top).astype(np.uint16)


def mean_degrees(found, truth, inside=None):
    length = np.linalg.norm(found, axis=2)
    cosine = (found * truth).sum(2) / np.where(length > 0, length, 1)
    angle = np.degrees(np.arccos(np.clip(np.where(length > 0, cosine, -1), -1, 1)))
    return float((angle if inside is None else angle[inside]).mean())
