#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the tables of this folder: python3 make_tables.py. README.md says what they are."""

import math
import pathlib

HERE = pathlib.Path(__file__).parent
WAVELENGTHS_NM = range(380, 740, 10)


def bell(nm, centre, width):
    return math.exp(-0.5 * ((nm - centre) / width) ** 2)


def two_sided(nm, centre, left, right):
    return bell(nm, centre, left if nm < centre else right)


def edge(nm, centre, width):
    """From 0 to 1 with rising wavelength."""
    return 1 / (1 + math.exp(-(nm - centre) / width))


def write(name, comments, curve):
    lines = [f"# {line}" for line in comments]
    lines += ["# nm value"] + [f"{nm} {curve(nm):.6f}" for nm in WAVELENGTHS_NM]
    path = HERE / name
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join(lines) + "\n")


def glass(nm):
    """What the stack in front of a sensor lets through: no ultraviolet, no infrared."""
    return edge(nm, 405, 5) * (1 - edge(nm, 672, 11))


LIGHT_AND_FILTERS = {
    "led_white.txt": (
        "White LED of about 6500 K: a blue die that shines through its phosphor, relative to its peak",
        lambda nm: 0.98 * two_sided(nm, 450, 8.5, 11) + 0.497 * two_sided(nm, 548, 38, 68),
    ),
    "filter_red.txt": (
        "Red channel of a camera: filter, infrared cut and silicon",
        lambda nm: glass(nm) * (0.72 * two_sided(nm, 602, 19, 48) + 0.045 * bell(nm, 535, 35)
                                + 0.03 * bell(nm, 430, 18)),
    ),
    "filter_green.txt": (
        "Green channel of a camera: filter, infrared cut and silicon",
        lambda nm: glass(nm) * (0.95 * two_sided(nm, 530, 34, 38) + 0.05 * bell(nm, 640, 35)
                                + 0.02 * bell(nm, 430, 25)),
    ),
    "filter_blue.txt": (
        "Blue channel of a camera: filter, infrared cut and silicon",
        lambda nm: glass(nm) * (0.85 * two_sided(nm, 458, 28, 27) + 0.04 * bell(nm, 540, 30)
                                + 0.015 * bell(nm, 650, 30)),
    ),
}


def cotton(nm):
    return 0.88 - 0.30 * (1 - edge(nm, 415, 38))


DYES = {
    "undyed_cotton": ("Cotton, washed and not bleached: less blue than red", cotton),
    "bleached_cotton": (
        "Bleached cotton without brightener",
        lambda nm: 0.90 - 0.12 * (1 - edge(nm, 405, 20)),
    ),
    "raw_silk": ("Raw silk", lambda nm: 0.80 - 0.38 * (1 - edge(nm, 430, 45))),
    "indigo": (
        "Cotton dyed with indigo: one wide band in the orange, and red again beyond it",
        lambda nm: cotton(nm) * (0.045 + 0.16 * two_sided(nm, 435, 40, 50) + 0.62 * edge(nm, 722, 13)),
    ),
    "pale_indigo": (
        "Cotton dipped once in indigo",
        lambda nm: cotton(nm) * (0.36 + 0.30 * two_sided(nm, 445, 55, 60) + 0.50 * edge(nm, 708, 16)),
    ),
    "madder": (
        "Cotton dyed with madder on alum: two bands in the green",
        lambda nm: cotton(nm) * (0.085 + 0.03 * bell(nm, 425, 25) - 0.03 * bell(nm, 510, 14)
                                 - 0.035 * bell(nm, 545, 14) + 0.60 * edge(nm, 603, 13)),
    ),
    "weld": (
        "Cotton dyed with weld on alum",
        lambda nm: cotton(nm) * (0.07 + 0.80 * edge(nm, 492, 15)),
    ),
    "green": (
        "Weld over indigo",
        lambda nm: cotton(nm) * (0.05 + 0.17 * two_sided(nm, 525, 24, 45) + 0.45 * edge(nm, 715, 13)),
    ),
    "cochineal": (
        "Wool dyed with cochineal on tin",
        lambda nm: 0.06 + 0.09 * bell(nm, 430, 30) - 0.02 * bell(nm, 525, 12) - 0.025 * bell(nm, 562, 12)
        + 0.58 * edge(nm, 612, 14),
    ),
    "walnut": ("Wool dyed with walnut husks", lambda nm: 0.05 + 0.26 * edge(nm, 640, 55)),
    "black": (
        "Cotton dyed black: not black any more in the far red",
        lambda nm: 0.028 + 0.008 * bell(nm, 450, 40) + 0.14 * edge(nm, 722, 14),
    ),
}

GREYS_PERCENT = (90, 59, 36, 19, 9, 3)


def paint(level):
    """Titanium white and carbon black: flat, but for the violet that titanium white absorbs."""
    return lambda nm: level * (1 - 0.35 * (1 - edge(nm, 402, 9)))


# The colours that the makers of the classic chart give for it: sRGB in 8 bits, by rows from the top left.
CHART = (
    ("dark skin", 115, 82, 68), ("light skin", 194, 150, 130), ("blue sky", 98, 122, 157),
    ("foliage", 87, 108, 67), ("blue flower", 133, 128, 177), ("bluish green", 103, 189, 170),
    ("orange", 214, 126, 44), ("purplish blue", 80, 91, 166), ("moderate red", 193, 90, 99),
    ("purple", 94, 60, 108), ("yellow green", 157, 188, 64), ("orange yellow", 224, 163, 46),
    ("blue", 56, 61, 150), ("green", 70, 148, 73), ("red", 175, 54, 60),
    ("yellow", 231, 199, 31), ("magenta", 187, 86, 149), ("cyan", 8, 133, 161),
    ("white", 243, 243, 242), ("neutral 8", 200, 200, 200), ("neutral 6.5", 160, 160, 160),
    ("neutral 5", 122, 122, 121), ("neutral 3.5", 85, 85, 85), ("black", 52, 52, 52),
)

D65 = (
    49.9755, 54.6482, 82.7549, 91.486, 93.4318, 86.6823, 104.865, 117.008, 117.812, 114.861, 115.923, 108.811,
    109.354, 107.802, 104.79, 107.689, 104.405, 104.046, 100, 96.3342, 95.788, 88.6856, 90.0062, 89.5991,
    87.6987, 83.2886, 83.6992, 80.0268, 80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.349, 61.604, 69.8856,
)
REC709_FROM_XYZ = ((3.2404542, -1.5371385, -0.4985314), (-0.969266, 1.8760108, 0.041556),
                   (0.0556434, -0.2040259, 1.0572252))


def observer(nm):
    """CIE 1931 x, y, z by the fit of Wyman, Sloan and Shirley, JCGT 2(2), 2013."""
    x = (1.056 * two_sided(nm, 599.8, 37.9, 31.0) + 0.362 * two_sided(nm, 442.0, 16.0, 26.7)
         - 0.065 * two_sided(nm, 501.1, 20.4, 26.2))
    y = 0.821 * two_sided(nm, 568.8, 46.9, 40.5) + 0.286 * two_sided(nm, 530.9, 16.3, 31.1)
    z = 1.217 * two_sided(nm, 437.0, 11.8, 36.0) + 0.681 * two_sided(nm, 459.0, 26.0, 13.8)
    return x, y, z


def rec709(curve):
    def under_d65(reflectance):
        lit = [(nm, e * reflectance(nm)) for e, nm in zip(D65, WAVELENGTHS_NM)]
        xyz = [sum(light * observer(nm)[i] for nm, light in lit) for i in range(3)]
        return [sum(m * t for m, t in zip(row, xyz)) for row in REC709_FROM_XYZ]

    return [a / w for a, w in zip(under_d65(curve), under_d65(lambda nm: 1))]


def linear(display):
    v = display / 255
    return v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4


def solved(a, b):
    """x of a x = b, three equations (Cramer)."""
    def det(m):
        return sum(m[0][i] * (m[1][i - 2] * m[2][i - 1] - m[1][i - 1] * m[2][i - 2]) for i in range(3))

    def with_column(k):
        return [[b[r] if c == k else a[r][c] for c in range(3)] for r in range(3)]

    return [det(with_column(k)) / det(a) for k in range(3)]


def sigmoid_of_parabola(c):
    """Jakob and Hanika, Eurographics 2019: 0.5 + x / (2 sqrt(1 + x^2)), x a parabola of the wavelength."""
    def curve(nm):
        t = (nm - 555) / 175
        x = (c[0] * t + c[1]) * t + c[2]
        return 0.5 + x / (2 * math.sqrt(1 + x * x))

    return curve


def parabola_of_colour(target):
    """Newton's method with halved steps."""
    def misses(c):
        return [a - t for a, t in zip(rec709(sigmoid_of_parabola(c)), target)]

    grey = 2 * min(max(sum(target) / 3, 0.01), 0.99) - 1
    c = [0, 0, grey / math.sqrt(1 - grey * grey)]
    miss = misses(c)
    for _ in range(60):
        moved = [misses([v + 1e-5 * (i == k) for i, v in enumerate(c)]) for k in range(3)]
        slope = [[(moved[k][r] - miss[r]) / 1e-5 for k in range(3)] for r in range(3)]
        step = solved(slope, miss)
        share = 1.0
        while share > 1e-4:
            tried = [v - share * s for v, s in zip(c, step)]
            if math.dist(misses(tried), [0] * 3) < math.dist(miss, [0] * 3):
                break
            share /= 2
        c, miss = tried, misses(tried)
        if max(map(abs, miss)) < 1e-9:
            return c
    raise ValueError(f"no curve found for {target}")


def main():
    for name, (what, curve) in LIGHT_AND_FILTERS.items():
        write(name, [what], curve)
    for name, (what, curve) in DYES.items():
        write(f"dye/{name}.txt", [what], curve)
    for percent in GREYS_PERCENT:
        write(f"grey/{percent:02}.txt", [f"Grey paint of {percent} percent"], paint(percent / 100))
    for number, (name, *display) in enumerate(CHART, 1):
        c = parabola_of_colour([linear(v) for v in display])
        what = "Patch {}, {}: sRGB {} {} {}".format(number, name, *display)
        how = "0.5 + x / (2 sqrt(1 + x^2)), x = ({:.6f} t + {:.6f}) t + {:.6f}, t = (nm - 555) / 175".format(*c)
        write(f"chart/{number:02}.txt", [what, how], sigmoid_of_parabola(c))
    rows = [f"  [{red}, {green}, {blue}],  # {name}" for name, red, green, blue in CHART]
    (HERE / "chart" / "chart.toml").write_text("\n".join(["srgb = [", *rows, "]"]) + "\n")


if __name__ == "__main__":
    main()
