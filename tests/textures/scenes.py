"""Writes a glTF that shows the pictures side by side, and a GLB with some of them for the fuzz corpus."""

import base64
import json
import struct
import sys
from pathlib import Path

FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
CORPUS = FOLDER.parent / "corpus" / "gltf"

# Positions, texture coordinates and indices of a square of two units, facing +z.
CORNERS = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
POSITIONS = b"".join(struct.pack("<3f", x, y, 0) for x, y in CORNERS)
UVS = b"".join(struct.pack("<2f", (x + 1) / 2, (1 - y) / 2) for x, y in CORNERS)
INDICES = struct.pack("<6H", 0, 1, 2, 0, 2, 3)
SQUARE = POSITIONS + UVS + INDICES


def texture(name, image):
    extension = {"ktx2": "KHR_texture_basisu", "webp": "EXT_texture_webp"}.get(name.split(".")[-1])
    return {"extensions": {extension: {"source": image}}} if extension else {"source": image}


def document(names, columns):
    """Squares from left to right, then from top to bottom, each with one picture."""
    rows = -(-len(names) // columns)
    places = [(2 * (i % columns) - columns + 1, rows - 1 - 2 * (i // columns)) for i in range(len(names))]
    square = {"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}
    material = lambda i: {
        "pbrMetallicRoughness": {"baseColorTexture": {"index": i}},
        "alphaMode": "BLEND", "extensions": {"KHR_materials_unlit": {}},
    }
    return {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["EXT_texture_webp", "KHR_materials_unlit", "KHR_texture_basisu"],
        "extensionsRequired": ["EXT_texture_webp", "KHR_texture_basisu"],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 32},
            {"buffer": 0, "byteOffset": 80, "byteLength": 12},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
            {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "meshes": [{"primitives": [square | {"material": i}]} for i in range(len(names))],
        "materials": [material(i) for i in range(len(names))],
        "textures": [texture(name, i) for i, name in enumerate(names)],
        "cameras": [{
            "type": "orthographic",
            "orthographic": {"xmag": columns, "ymag": rows, "znear": 0.5, "zfar": 10},
        }],
        "nodes": [{"mesh": i, "translation": [x, y, 0]} for i, (x, y) in enumerate(places)]
        + [{"camera": 0, "translation": [0, 0, 2]}],
        "scenes": [{"nodes": list(range(len(names) + 1))}],
        "scene": 0,
    }


NAMES = ["color.png", "color_etc1s.ktx2", "color_uastc_zstd.ktx2", "color_lossy.webp", "color_rgba8.ktx2", "normal.png"]
gltf = document(NAMES, 3)
gltf["images"] = [{"uri": name} for name in NAMES]
uri = f"data:application/octet-stream;base64,{base64.b64encode(SQUARE).decode()}"
gltf["buffers"] = [{"byteLength": len(SQUARE), "uri": uri}]
(FOLDER / "squares.gltf").write_text(json.dumps(gltf, indent=1) + "\n")

NAMES = ["opaque_etc1s.ktx2", "odd_uastc.ktx2", "color_lossless.webp", "opaque_lossy.webp"]
glb, binary = document(NAMES, 2), bytearray(SQUARE)
glb["images"] = []
for i, name in enumerate(NAMES):
    data = (FOLDER / name).read_bytes()
    binary += b"\0" * (-len(binary) % 4)
    glb["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
    glb["images"].append({"bufferView": len(glb["bufferViews"]) - 1})
    binary += data
binary += b"\0" * (-len(binary) % 4)
glb["buffers"] = [{"byteLength": len(binary)}]
text = json.dumps(glb, separators=(",", ":")).encode()
text += b" " * (-len(text) % 4)
chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
(CORPUS / "textures.glb").write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
