"""Draws the source pictures and encodes them as WebP; writes what libwebp decodes as PNG beside each lossy file."""

import math
import sys
from pathlib import Path

from PIL import Image

FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
SIDE = 64


def color(width, height, alpha):
    """Smooth waves of brightness over a slow change of hue, so that ETC1S, which has one color per block, stays close."""
    picture = Image.new("RGBA", (width, height))
    for y in range(height):
        for x in range(width):
            u, v = (x + 0.5) / SIDE, (y + 0.5) / SIDE
            wave = 30 * math.sin(2 * math.pi * u) * math.cos(2 * math.pi * v)
            texel = [140 + wave + 16 * u, 120 + wave - 12 * v, 100 + wave + 8 * (v - u)]
            picture.putpixel((x, y), (*(round(c) for c in texel), round(255 - 191 * u) if alpha else 255))
    return picture


def normal():
    """Waves as a tangent-space normal map."""
    picture = Image.new("RGB", (SIDE, SIDE))
    for y in range(SIDE):
        for x in range(SIDE):
            u, v = (x + 0.5) / SIDE, (y + 0.5) / SIDE
            slope = [0.5 * math.cos(2 * math.pi * u), 0.4 * math.sin(2 * math.pi * v), 1.0]
            length = math.sqrt(sum(c * c for c in slope))
            picture.putpixel((x, y), tuple(round(127.5 + 127.5 * c / length) for c in slope))
    return picture


def save(name, picture, **options):
    picture.save(FOLDER / name, **options)


with_alpha, opaque = color(SIDE, SIDE, True), color(SIDE, SIDE, False).convert("RGB")
save("color.png", with_alpha, optimize=True)
save("opaque.png", opaque, optimize=True)
save("odd.png", color(30, 22, True), optimize=True)
save("normal.png", normal(), optimize=True)
save("color_lossless.webp", with_alpha, lossless=True, exact=True, quality=100, method=6)
save("color_lossy.webp", with_alpha, quality=98, alpha_quality=100, exact=True, method=6)
save("opaque_lossy.webp", opaque, quality=98, method=6)
for name in ["color_lossy", "opaque_lossy"]:
    save(f"{name}.expected.png", Image.open(FOLDER / f"{name}.webp").convert("RGBA"), optimize=True)
