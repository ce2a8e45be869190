// Encodes the pictures as KTX2 with the encoder of Basis Universal, and writes what its transcoder decodes beside them:
// level 0 as PNG, and hashes of the blocks of every level in every block format.

import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { deflateSync } from "node:zlib";
import { encodeToKTX2 } from "ktx2-encoder";
import { read, write } from "ktx-parse";
import { PNG } from "pngjs";

const require = createRequire(import.meta.url);
const folder = process.argv[2] ?? ".";
const load = (name) => readFileSync(`${folder}/${name}`);
const imageDecoder = async (bytes) => {
  const { data, width, height } = PNG.sync.read(Buffer.from(bytes));
  return { data: new Uint8Array(data), width, height };
};

const encode = async (source, options) =>
  encodeToKTX2(new Uint8Array(load(source)), { imageDecoder, enableDebug: false, isKTX2File: true, ...options });
const etc1s = { isUASTC: false, qualityLevel: 255, compressionLevel: 5, generateMipmap: true };
const uastc = { isUASTC: true, uastcLDRQualityLevel: 4, generateMipmap: true, needSupercompression: false };
const linear = { isNormalMap: true, isPerceptual: false, isSetKTX2SRGBTransferFunc: false };

const files = {
  "color_etc1s.ktx2": await encode("color.png", etc1s),
  "opaque_etc1s.ktx2": await encode("opaque.png", etc1s),
  "color_uastc.ktx2": await encode("color.png", uastc),
  "color_uastc_zstd.ktx2": await encode("color.png", { ...uastc, needSupercompression: true }),
  "color_one_level.ktx2": await encode("color.png", { ...uastc, needSupercompression: true, generateMipmap: false }),
  "odd_uastc.ktx2": await encode("odd.png", { ...uastc, generateMipmap: false }),
  "normal_uastc.ktx2": await encode("normal.png", { ...uastc, ...linear, needSupercompression: true }),
};

// The same texels with zlib (scheme 3), which the encoder does not write.
const zlib = read(files["color_uastc.ktx2"]);
zlib.supercompressionScheme = 3;
for (const level of zlib.levels) {
  level.uncompressedByteLength = level.levelData.byteLength;
  level.levelData = new Uint8Array(deflateSync(level.levelData));
}
files["color_uastc_zlib.ktx2"] = write(zlib, { keepWriter: true });

// Without compression: VK_FORMAT_R8G8B8A8_SRGB and VK_FORMAT_R8G8B8_SRGB.
const sample = (i, type) => ({
  bitOffset: 8 * i, bitLength: 7, channelType: type, samplePosition: [0, 0, 0, 0], sampleLower: 0, sampleUpper: 255,
});
const plain = (source, channels, vkFormat) => {
  const { data, width, height } = PNG.sync.read(load(source));
  const texels = new Uint8Array(width * height * channels);
  for (let i = 0; i < width * height; i++) texels.set(data.subarray(4 * i, 4 * i + channels), channels * i);
  const container = read(files["color_uastc.ktx2"]);
  const [descriptor] = container.dataFormatDescriptor;
  Object.assign(descriptor, {
    colorModel: 1, texelBlockDimension: [0, 0, 0, 0], bytesPlane: [channels, 0, 0, 0, 0, 0, 0, 0],
    samples: [0, 1, 2, 15 | 16].slice(0, channels).map((type, i) => sample(i, type)),
  });
  Object.assign(container, { vkFormat, typeSize: 1, pixelWidth: width, pixelHeight: height, levelCount: 1 });
  container.levels = [{ levelData: texels, uncompressedByteLength: texels.byteLength }];
  return write(container, { keepWriter: true });
};
files["color_rgba8.ktx2"] = plain("color.png", 4, 43);
files["opaque_rgb8.ktx2"] = plain("opaque.png", 3, 29);

for (const [name, bytes] of Object.entries(files)) writeFileSync(`${folder}/${name}`, bytes);

// The reference transcoder, in the build that three.js ships.
const transcoder = require.resolve("three").replace(/build.*/, "examples/jsm/libs/basis/basis_transcoder");
const module = { exports: {} };
new Function("module", "exports", "require", "__dirname", readFileSync(`${transcoder}.js`, "utf8"))(
  module, module.exports, require, ".",
);
const basis = await module.exports({ wasmBinary: readFileSync(`${transcoder}.wasm`) });
basis.initializeBasis();
// Numbers of `transcoder_texture_format`.
const TARGETS = { rgba8: 13, bc7: 6, etc2: 1, astc: 10 };
const fnv = (bytes, hash = 0xcbf29ce484222325n) =>
  bytes.reduce((hash, byte) => ((hash ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn, hash);
const lines = [];
for (const name of Object.keys(files).filter((name) => !/zlib|rgb/.test(name))) {
  const file = new basis.KTX2File(new Uint8Array(files[name]));
  if (!file.isValid() || !file.startTranscoding()) throw new Error(name);
  for (const [target, number] of Object.entries(TARGETS)) {
    // Builds for the web have smaller tables for opaque ETC1S (BASISD_SUPPORT_ASTC_HIGHER_OPAQUE_QUALITY).
    if (target === "astc" && name === "opaque_etc1s.ktx2") continue;
    let hash;
    for (let level = 0; level < file.getLevels(); level++) {
      const texels = new Uint8Array(file.getImageTranscodedSizeInBytes(level, 0, 0, number));
      if (!file.transcodeImage(texels, level, 0, 0, number, 0, -1, -1)) throw new Error(`${name} ${target}`);
      hash = fnv(texels, hash);
      // The others have the texels of `color_uastc.ktx2`.
      if (target === "rgba8" && level === 0 && !/zstd|one_level/.test(name)) {
        const png = new PNG({ width: file.getWidth(), height: file.getHeight() });
        png.data = Buffer.from(texels);
        writeFileSync(`${folder}/${name.replace(".ktx2", ".expected.png")}`, PNG.sync.write(png));
      }
    }
    lines.push(`${name} ${target} ${file.getLevels()} ${hash.toString(16).padStart(16, "0")}`);
  }
  file.close();
}
writeFileSync(`${folder}/levels.txt`, `${lines.join("\n")}\n`);
