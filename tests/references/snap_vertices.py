#!/usr/bin/env python3
"""Moves vertices like a rasterizer with 4 sub-pixel bits: python3 snap_vertices.py SCENE.glb STATEMENT.json OUT.glb

Each vertex is moved within the plane of its view depth, so that it projects to a multiple of 1/16 pixel, as SwiftShader snaps it.
All vertices are also moved down by 1/128 pixel. Pixel centers on horizontal edges then belong to the triangle above: WebGL's
pictures are drawn upside down, which reverses this part of the fill rule. A picture of OUT.glb by a rasterizer with more
sub-pixel bits covers the same pixels as one of SCENE.glb by SwiftShader.

Nodes may have a translation, and no other transform or children. Needs numpy.
"""
import copy
import json
import struct
import sys

import numpy as np

SUBPIXELS = 16
DOWN_PX = 1 / 128


def read(path):
    """Returns the JSON and the bytes of the buffer of a GLB."""
    with open(path, "rb") as file:
        data = file.read()
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), bytearray(data[20 + length + 8 :])


def write(path, scene, buffer):
    """Writes a GLB."""
    scene["buffers"][0]["byteLength"] = len(buffer)
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    buffer += b"\0" * (-len(buffer) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(buffer), b"BIN\0") + buffer
    with open(path, "wb") as file:
        file.write(b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks)


def snapped(points, camera, size):
    """Returns world positions that project to multiples of 1/16 pixel, at the same view depths."""
    eye, center, up = (np.array(camera[key], float) for key in ("eye", "center", "up"))
    forward = (center - eye) / np.linalg.norm(center - eye)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    axes = np.stack([right, np.cross(right, forward), forward])
    view = (points - eye) @ axes.T
    pixels_per_slope = size[1] / 2 / np.tan(np.radians(camera["fov_y_deg"]) / 2)
    scale = pixels_per_slope / view[:, 2:]
    middle = np.array(size) / 2
    pixels = view[:, :2] * scale * [1, -1] + middle
    pixels = np.round(pixels * SUBPIXELS) / SUBPIXELS + [0, DOWN_PX]
    view[:, :2] = (pixels - middle) * [1, -1] / scale
    return view @ axes + eye


def main(scene_path, statement_path, out_path):
    scene, buffer = read(scene_path)
    with open(statement_path, encoding="utf-8") as file:
        statement = json.load(file)
    statement = statement.get("scene", statement)
    meshes = []
    for node in scene["nodes"]:
        if "mesh" not in node:
            continue
        if {"matrix", "rotation", "scale", "children"} & node.keys():
            sys.exit(f"{scene_path}: node {node.get('name')} has more than a translation")
        place = np.array(node.get("translation", [0, 0, 0]), float)
        # A mesh that several nodes share has other positions in each of them.
        mesh = copy.deepcopy(scene["meshes"][node["mesh"]])
        node["mesh"] = len(meshes)
        meshes.append(mesh)
        for primitive in mesh["primitives"]:
            accessor = copy.deepcopy(scene["accessors"][primitive["attributes"]["POSITION"]])
            view = scene["bufferViews"][accessor["bufferView"]]
            start = view.get("byteOffset", 0) + accessor.pop("byteOffset", 0)
            stride = view.get("byteStride", 12)
            points = np.array([struct.unpack_from("<3f", buffer, start + i * stride) for i in range(accessor["count"])])
            moved = (snapped(points + place, statement["camera"], statement["resolution"]) - place).astype("<f4")
            buffer += b"\0" * (-len(buffer) % 4)
            accessor.update(bufferView=len(scene["bufferViews"]), min=moved.min(0).tolist(), max=moved.max(0).tolist())
            scene["bufferViews"].append({"buffer": 0, "byteOffset": len(buffer), "byteLength": moved.nbytes})
            buffer += moved.tobytes()
            primitive["attributes"]["POSITION"] = len(scene["accessors"])
            scene["accessors"].append(accessor)
    scene["meshes"] = meshes
    write(out_path, scene, buffer)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
