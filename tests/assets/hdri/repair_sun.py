#!/usr/bin/env python3
"""Repairs the sun of park.hdr, whose red and green were lost: python3 repair_sun.py park.hdr

A texel near the brightest one is damaged if its red and green are below 0.001: the sky around the sun has 5 and more. Its blue
is kept, but is no lower than the mean of the ring: the sound texels that touch damaged ones. Red and green follow from blue in
the ratios of the ring. Only scanlines with damaged texels are encoded anew. Needs the standard library alone.
"""
import math
import sys

REACH = 5  # texels from the brightest one


def decode(data):
    """Returns the width, and for each scanline its start, end and texels as RGBE."""
    head = data.index(b"\n\n") + 2
    at = data.index(b"\n", head) + 1
    _, height, _, width = data[head : at - 1].split()
    rows = []
    for _ in range(int(height)):
        start, channels = at, []
        assert data[at : at + 2] == b"\2\2", "run-length encoded scanlines are needed"
        at += 4
        for _ in range(4):
            channel = bytearray()
            while len(channel) < int(width):
                count = data[at]
                if count > 128:
                    channel += data[at + 1 : at + 2] * (count - 128)
                    at += 2
                else:
                    channel += data[at + 1 : at + 1 + count]
                    at += 1 + count
            channels.append(channel)
        rows.append((start, at, list(zip(*channels))))
    return int(width), rows


def encode(texels):
    """Returns a scanline as runs of literal bytes."""
    out = bytearray(b"\2\2" + len(texels).to_bytes(2, "big"))
    for channel in zip(*texels):
        for at in range(0, len(channel), 128):
            part = bytes(channel[at : at + 128])
            out += bytes([len(part)]) + part
    return out


def light(rgbe):
    return [c * math.ldexp(1.0, rgbe[3] - 136) if rgbe[3] else 0.0 for c in rgbe[:3]]


def rgbe(rgb):
    _, exponent = math.frexp(max(rgb))
    return (*(min(255, round(c * math.ldexp(1.0, 8 - exponent))) for c in rgb), exponent + 128)


def main(path):
    data = open(path, "rb").read()
    width, rows = decode(data)
    peak = max(((y, x) for y in range(len(rows)) for x in range(width)), key=lambda p: max(light(rows[p[0]][2][p[1]])))
    near = [
        (y, x)
        for y in range(peak[0] - REACH - 1, peak[0] + REACH + 2)
        for x in range(peak[1] - REACH - 1, peak[1] + REACH + 2)
    ]
    damaged = {(y, x) for y, x in near if max(light(rows[y][2][x])[:2]) < 0.001}
    if not damaged:
        sys.exit(f"{path}: the sun is sound")
    touches = lambda y, x: any((y + dy, x + dx) in damaged for dy in (-1, 0, 1) for dx in (-1, 0, 1))
    ring = [light(rows[y][2][x]) for y, x in near if (y, x) not in damaged and touches(y, x)]
    mean = [sum(channel) / len(ring) for channel in zip(*ring)]
    for y, x in damaged:
        blue = max(light(rows[y][2][x])[2], mean[2])
        rows[y][2][x] = rgbe([blue * c / mean[2] for c in mean])
    out = bytearray(data[: rows[0][0]])
    for y, (start, end, texels) in enumerate(rows):
        out += encode(texels) if any(row == y for row, _ in damaged) else data[start:end]
    out += data[rows[-1][1] :]
    open(path, "wb").write(out)
    ratios = " : ".join(f"{c / mean[2]:.3f}" for c in mean)
    print(f"{len(damaged)} texels about ({peak[1]}, {peak[0]}) repaired from {len(ring)}: R : G : B = {ratios}")


main(sys.argv[1])
