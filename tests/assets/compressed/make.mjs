// Writes the files of this folder. README.md has the command.
import { writeFileSync } from 'node:fs';
import draco3d from 'draco3d';
import draco11 from 'draco3d-1.1';
import { MeshoptEncoder, MeshoptDecoder } from 'meshoptimizer';
import { NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { draco, meshopt } from '@gltf-transform/functions';

await MeshoptEncoder.ready;
await MeshoptDecoder.ready;
const dracoEncoder = await draco3d.createEncoderModule({});
const dracoDecoder = await draco3d.createDecoderModule({});
const oldEncoder = draco11.createEncoderModule({});

const FLOAT = 5126, BYTE = 5120, U8 = 5121, SHORT = 5122, U16 = 5123, U32 = 5125;
const bytesOf = (array) => new Uint8Array(array.buffer, array.byteOffset, array.byteLength);

/// A document under construction, with one binary chunk.
class Document {
  constructor() {
    this.json = {
      asset: { version: '2.0' }, scene: 0, scenes: [{ nodes: [0] }], nodes: [{ mesh: 0 }],
      materials: [{ pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 0.8 } }],
      meshes: [{ primitives: [] }], accessors: [], bufferViews: [], buffers: [],
    };
    this.chunks = [];
    this.length = 0;
    this.fallbackLength = 0;
  }
  require(name, required = true) {
    for (const list of required ? ['extensionsUsed', 'extensionsRequired'] : ['extensionsUsed']) {
      const names = (this.json[list] ??= []);
      if (!names.includes(name)) names.push(name);
    }
  }
  append(bytes) {
    const start = this.length;
    const padded = new Uint8Array((bytes.length + 3) & ~3);
    padded.set(bytes);
    this.chunks.push(padded);
    this.length += padded.length;
    return start;
  }
  view(bytes, stride) {
    const view = { buffer: 0, byteOffset: this.append(bytes), byteLength: bytes.length };
    if (stride) view.byteStride = stride;
    return this.json.bufferViews.push(view) - 1;
  }
  /// A compressed view; its uncompressed copy would lie in buffer 1, which has no data.
  compressed(extension, { bytes, count, stride, mode, filter, version }, vertices) {
    const stream = MeshoptEncoder.encodeGltfBuffer(bytes, count, stride, mode, version ?? 0);
    const json = {
      buffer: 0, byteOffset: this.append(stream), byteLength: stream.length, byteStride: stride, count, mode,
    };
    if (filter) json.filter = filter;
    this.require(extension);
    const view = {
      buffer: 1, byteOffset: this.fallbackLength, byteLength: count * stride, extensions: { [extension]: json },
    };
    if (vertices) view.byteStride = stride;
    this.fallbackLength += (count * stride + 3) & ~3;
    this.fallback = extension;
    return this.json.bufferViews.push(view) - 1;
  }
  accessor(bufferView, componentType, type, count, more = {}) {
    return this.json.accessors.push({ bufferView, componentType, type, count, ...more }) - 1;
  }
  array(array, componentType, type, count, more) {
    return this.accessor(this.view(bytesOf(array)), componentType, type, count, more);
  }
  primitive(primitive) {
    this.json.meshes[0].primitives.push({ material: 0, ...primitive });
    return this;
  }
  glb() {
    this.json.buffers = [{ byteLength: this.length }];
    if (this.fallback) {
      this.json.buffers.push({ byteLength: this.fallbackLength, extensions: { [this.fallback]: { fallback: true } } });
    }
    const text = new TextEncoder().encode(JSON.stringify(this.json));
    const jsonLength = (text.length + 3) & ~3;
    const glb = new Uint8Array(28 + jsonLength + this.length).fill(0x20);
    const words = new DataView(glb.buffer);
    [0x46546c67, 2, glb.length, jsonLength, 0x4e4f534a].forEach((word, i) => words.setUint32(4 * i, word, true));
    glb.set(text, 20);
    words.setUint32(20 + jsonLength, this.length, true);
    words.setUint32(24 + jsonLength, 0x004e4942, true);
    let at = 28 + jsonLength;
    for (const chunk of this.chunks) { glb.set(chunk, at); at += chunk.length; }
    return glb;
  }
}

const written = [];
function write(name, bytes) {
  writeFileSync(new URL(name, import.meta.url), bytes);
  written.push(`${name} ${bytes.length}`);
}

/// A torus with a seam. The color of a vertex states its number, so that vertices can be told apart in any order.
function torus(around, across) {
  const positions = [], normals = [], uvs = [], colors = [], indices = [];
  for (let i = 0; i <= around; i++) {
    for (let j = 0; j <= across; j++) {
      const [u, v] = [i / around, j / across];
      const [a, b] = [2 * Math.PI * (i % around) / around, 2 * Math.PI * (j % across) / across];
      const normal = [Math.cos(a) * Math.cos(b), Math.sin(b), Math.sin(a) * Math.cos(b)];
      positions.push(Math.cos(a) + 0.4 * normal[0], 0.4 * normal[1], Math.sin(a) + 0.4 * normal[2]);
      normals.push(...normal);
      uvs.push(0.97 * u, 0.97 * v);
      const vertex = i * (across + 1) + j;
      colors.push(vertex & 255, vertex >> 8, 128 + Math.round(100 * Math.sin(a)), 255);
      if (i < around && j < across) {
        const [p, q] = [vertex, vertex + across + 1];
        indices.push(p, p + 1, q, q, p + 1, q + 1);
      }
    }
  }
  return {
    count: uvs.length / 2, positions: new Float32Array(positions), normals: new Float32Array(normals),
    uvs: new Float32Array(uvs), colors: new Uint8Array(colors), indices: new Uint16Array(indices),
  };
}

function bounds(values, width) {
  const [min, max] = [new Array(width).fill(Infinity), new Array(width).fill(-Infinity)];
  values.forEach((value, i) => {
    min[i % width] = Math.min(min[i % width], value);
    max[i % width] = Math.max(max[i % width], value);
  });
  return { min, max };
}

function raw(mesh) {
  const d = new Document();
  return d.primitive({
    attributes: {
      POSITION: d.array(mesh.positions, FLOAT, 'VEC3', mesh.count, bounds(mesh.positions, 3)),
      NORMAL: d.array(mesh.normals, FLOAT, 'VEC3', mesh.count),
      TEXCOORD_0: d.array(mesh.uvs, FLOAT, 'VEC2', mesh.count),
      COLOR_0: d.array(mesh.colors, U8, 'VEC4', mesh.count, { normalized: true }),
    },
    indices: d.array(mesh.indices, U16, 'SCALAR', mesh.indices.length),
  });
}

/// Positions as 16-bit numbers with the node's transform, normals in three bytes, texture coordinates in two halves.
function quantizedArrays(mesh) {
  const pad = (values, width, padded, Type, max) => {
    const out = new Type(values.length / width * padded);
    values.forEach((value, i) => { out[Math.floor(i / width) * padded + i % width] = Math.round(value * max); });
    return out;
  };
  return {
    positions: pad(mesh.positions.map((p) => p / 1.5), 3, 4, Int16Array, 32767), scale: 1.5,
    normals: pad(mesh.normals, 3, 4, Int8Array, 127), uvs: pad(mesh.uvs, 2, 2, Uint16Array, 65535),
  };
}

function quantized(mesh) {
  const d = new Document();
  d.require('KHR_mesh_quantization');
  const q = quantizedArrays(mesh);
  d.json.nodes[0].scale = [q.scale, q.scale, q.scale];
  const array = (array, stride, kind, type) =>
    d.accessor(d.view(bytesOf(array), stride), kind, type, mesh.count, { normalized: true });
  return d.primitive({
    attributes: {
      POSITION: array(q.positions, 8, SHORT, 'VEC3'), NORMAL: array(q.normals, 4, BYTE, 'VEC3'),
      TEXCOORD_0: array(q.uvs, 4, U16, 'VEC2'), COLOR_0: array(mesh.colors, 4, U8, 'VEC4'),
    },
    indices: d.array(mesh.indices, U16, 'SCALAR', mesh.indices.length),
  });
}

/// Compresses a mesh. Bits of 0 keep floats.
function dracoBytes(mesh, { method, speed, bits, module = dracoEncoder, colors, joints, weights }) {
  const builder = new module.MeshBuilder(), target = new module.Mesh(), encoder = new module.Encoder();
  builder.AddFacesToMesh(target, mesh.indices.length / 3, Uint32Array.from(mesh.indices));
  const ids = {};
  const add = (name, kind, width, values) => {
    const calls = [
      [Uint8Array, 'AddUInt8Attribute'], [Int32Array, 'AddInt32Attribute'], [Float32Array, 'AddFloatAttributeToMesh'],
    ];
    const [, call] = calls.find(([Type]) => values instanceof Type);
    ids[name] = builder[call](target, kind, mesh.count, width, values);
  };
  add('POSITION', module.POSITION, 3, mesh.positions);
  if (mesh.normals) add('NORMAL', module.NORMAL, 3, mesh.normals);
  if (mesh.uvs) add('TEXCOORD_0', module.TEX_COORD, 2, mesh.uvs);
  if (mesh.colors) add('COLOR_0', module.COLOR, 4, colors ?? mesh.colors);
  if (joints) add('JOINTS_0', module.GENERIC, 4, joints);
  if (weights) add('WEIGHTS_0', module.GENERIC, 4, weights);
  encoder.SetSpeedOptions(speed, speed);
  encoder.SetEncodingMethod(method === 'edgebreaker' ? module.MESH_EDGEBREAKER_ENCODING : module.MESH_SEQUENTIAL_ENCODING);
  const kinds = [module.POSITION, module.NORMAL, module.TEX_COORD, module.GENERIC];
  kinds.forEach((kind, i) => { if (bits[i]) encoder.SetAttributeQuantization(kind, bits[i]); });
  const out = new module.DracoInt8Array();
  const length = encoder.EncodeMeshToDracoBuffer(target, out);
  const bytes = new Uint8Array(length);
  for (let i = 0; i < length; i++) bytes[i] = out.GetValue(i);
  return { bytes, ids, ...decodedCounts(bytes) };
}

function decodedCounts(bytes) {
  const decoder = new dracoDecoder.Decoder(), mesh = new dracoDecoder.Mesh();
  const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
  if (!status.ok()) throw new Error(status.error_msg());
  return { points: mesh.num_points(), faces: mesh.num_faces() };
}

function dracoFile(mesh, options) {
  const d = new Document();
  d.require('KHR_draco_mesh_compression');
  const { bytes, ids, points, faces } = dracoBytes(mesh, options);
  const accessor = (componentType, type, count, more = {}) =>
    d.json.accessors.push({ componentType, type, count, ...more }) - 1;
  const attributes = {
    POSITION: accessor(FLOAT, 'VEC3', points, bounds(mesh.positions, 3)),
    NORMAL: accessor(FLOAT, 'VEC3', points),
    TEXCOORD_0: accessor(FLOAT, 'VEC2', points),
    COLOR_0: options.colors instanceof Float32Array
      ? accessor(FLOAT, 'VEC4', points) : accessor(U8, 'VEC4', points, { normalized: true }),
  };
  const extension = { bufferView: d.view(bytes), attributes: ids };
  return d.primitive({
    attributes, indices: accessor(U16, 'SCALAR', 3 * faces), extensions: { KHR_draco_mesh_compression: extension },
  });
}

const floatColors = (mesh) => Float32Array.from(mesh.colors, (c) => c / 255);
// Meshes below 1000 triangles are never encoded by valence.
const mesh = torus(32, 16);
write('raw.glb', raw(mesh).glb());
write('quantized.glb', quantized(mesh).glb());
const fine = [14, 10, 12, 0], coarse = [8, 6, 7, 0], kept = [0, 0, 0, 0];
const dracos = {
  draco_edgebreaker_0: { method: 'edgebreaker', speed: 0, bits: fine },
  draco_edgebreaker_5: { method: 'edgebreaker', speed: 5, bits: fine },
  draco_edgebreaker_10: { method: 'edgebreaker', speed: 10, bits: fine },
  draco_coarse: { method: 'edgebreaker', speed: 3, bits: coarse },
  // Integers of 32 bits in the stream, bytes in the accessor.
  draco_sequential: { method: 'sequential', speed: 10, bits: fine, colors: Int32Array.from(mesh.colors) },
  draco_lossless: { method: 'edgebreaker', speed: 5, bits: kept },
  // Version 1.1 of the library has no attributes of bytes.
  draco_bitstream_2_1: {
    method: 'edgebreaker', speed: 5, bits: fine, module: oldEncoder, colors: floatColors(mesh),
  },
};
for (const [name, options] of Object.entries(dracos)) write(`${name}.glb`, dracoFile(mesh, options).glb());

/// Streams for the decoder alone: what was compressed, and what the official decoder makes of it.
const streams = [];
function keep(name, { bytes, count, stride, mode, filter, version }, level) {
  const stream = level === undefined
    ? MeshoptEncoder.encodeGltfBuffer(bytes, count, stride, mode, version ?? 0)
    : MeshoptEncoder.encodeVertexBufferLevel(bytes, count, stride, level, version);
  const decoded = new Uint8Array(count * stride);
  MeshoptDecoder.decodeGltfBuffer(decoded, count, stride, stream, mode, filter);
  const text = (array) => Buffer.from(array).toString('base64');
  streams.push({ name, count, stride, mode, filter: filter ?? 'NONE', stream: text(stream), decoded: text(decoded) });
}

function meshoptFile(mesh, extension, version, wide, filters) {
  const d = new Document();
  const count = mesh.count;
  const view = (bytes, stride, filter) =>
    d.compressed(extension, { bytes, count, stride, mode: 'ATTRIBUTES', filter, version }, true);
  const attributes = {};
  const rgba = floatColors(mesh);
  const vec4 = new Float32Array(4 * count);
  mesh.normals.forEach((n, i) => { vec4[Math.floor(i / 3) * 4 + i % 3] = n; });
  if (filters) {
    const positions = MeshoptEncoder.encodeFilterExp(mesh.positions, count, 12, 16, 'SharedVector');
    const normals = MeshoptEncoder.encodeFilterOct(vec4, count, wide ? 8 : 4, wide ? 12 : 8);
    const uvs = MeshoptEncoder.encodeFilterExp(mesh.uvs, count, 8, 12, 'Separate');
    attributes.POSITION = d.accessor(view(positions, 12, 'EXPONENTIAL'), FLOAT, 'VEC3', count, bounds(mesh.positions, 3));
    attributes.NORMAL =
      d.accessor(view(normals, wide ? 8 : 4, 'OCTAHEDRAL'), wide ? SHORT : BYTE, 'VEC3', count, { normalized: true });
    attributes.TEXCOORD_0 = d.accessor(view(uvs, 8, 'EXPONENTIAL'), FLOAT, 'VEC2', count);
    const colors = extension.startsWith('KHR')
      ? view(MeshoptEncoder.encodeFilterColor(rgba, count, wide ? 8 : 4, wide ? 12 : 8), wide ? 8 : 4, 'COLOR')
      : view(mesh.colors, 4);
    const wideColors = wide && extension.startsWith('KHR');
    attributes.COLOR_0 = d.accessor(colors, wideColors ? U16 : U8, 'VEC4', count, { normalized: true });
    d.require('KHR_mesh_quantization');
  } else {
    const array = (values, stride, type) => d.accessor(view(bytesOf(values), stride), FLOAT, type, count);
    attributes.POSITION = array(mesh.positions, 12, 'VEC3');
    attributes.NORMAL = array(mesh.normals, 12, 'VEC3');
    attributes.TEXCOORD_0 = array(mesh.uvs, 8, 'VEC2');
    attributes.COLOR_0 = d.accessor(view(mesh.colors, 4), U8, 'VEC4', count, { normalized: true });
  }
  const indices = wide ? Uint32Array.from(mesh.indices) : mesh.indices;
  const mode = filters ? 'INDICES' : 'TRIANGLES';
  const stride = wide ? 4 : 2;
  const compressed = d.compressed(extension, { bytes: bytesOf(indices), count: indices.length, stride, mode });
  return d.primitive({ attributes, indices: d.accessor(compressed, wide ? U32 : U16, 'SCALAR', indices.length) });
}
write('meshopt_v0.glb', meshoptFile(mesh, 'EXT_meshopt_compression', 0, false, false).glb());
write('meshopt_v1.glb', meshoptFile(mesh, 'KHR_meshopt_compression', 1, true, false).glb());
write('meshopt_filters_v0.glb', meshoptFile(mesh, 'EXT_meshopt_compression', 0, false, true).glb());
write('meshopt_filters_v1.glb', meshoptFile(mesh, 'KHR_meshopt_compression', 1, false, true).glb());
write('meshopt_filters_wide.glb', meshoptFile(mesh, 'KHR_meshopt_compression', 1, true, true).glb());

/// A strip of squares along y that two joints bend, with one morph target and an animation.
function strip() {
  const rows = 9, positions = [], joints = [], weights = [], indices = [], moved = [];
  for (let row = 0; row < rows; row++) {
    for (const x of [-0.25, 0.25]) {
      const y = row / (rows - 1), weight = Math.round(y * 8) / 8;
      positions.push(x, 2 * y, 0);
      joints.push(0, 1, 0, 0);
      weights.push(1 - weight, weight, 0, 0);
      moved.push(0, 0, 0.5 * Math.sin(Math.PI * y));
    }
    if (row + 1 < rows) indices.push(...[0, 1, 2, 2, 1, 3].map((i) => 2 * row + i));
  }
  return {
    count: 2 * rows, positions: new Float32Array(positions), indices: new Uint16Array(indices),
    joints: new Uint8Array(joints), weights: new Float32Array(weights), moved: new Float32Array(moved),
  };
}

/// `arrays` makes the accessors of the mesh; rotations of the upper joint are 16-bit numbers.
function stripFile(arrays) {
  const d = new Document(), s = strip(), { rotations, times, bind, ...primitive } = arrays(d, s);
  d.json.nodes = [{ mesh: 0, skin: 0 }, { children: [2] }, { translation: [0, 1, 0] }];
  d.json.scenes = [{ nodes: [0, 1] }];
  d.json.skins = [{ joints: [1, 2], inverseBindMatrices: bind }];
  d.json.meshes[0].weights = [1];
  const channel = (node, path, sampler) => ({ sampler, target: { node, path } });
  d.json.animations = [{
    channels: [channel(2, 'rotation', 0)], samplers: [{ input: times, output: rotations }],
  }];
  return d.primitive(primitive);
}
const keys = 5;
const times = Float32Array.from({ length: keys }, (_, i) => i / 4);
const quaternions = new Float32Array(4 * keys);
for (let i = 0; i < keys; i++) quaternions.set([Math.sin(0.2 * i), 0, 0, Math.cos(0.2 * i)], 4 * i);
const shorts = Int16Array.from(quaternions, (c) => Math.round(32767 * c));
const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const binds = new Float32Array([...identity, ...identity]);
binds[16 + 13] = -1;

const plain = (d) => ({
  times: d.array(times, FLOAT, 'SCALAR', keys, bounds(times, 1)),
  rotations: d.array(shorts, SHORT, 'VEC4', keys, { normalized: true }),
  bind: d.array(binds, FLOAT, 'MAT4', 2),
});
write('strip_raw.glb', stripFile((d, s) => ({
  ...plain(d),
  attributes: {
    POSITION: d.array(s.positions, FLOAT, 'VEC3', s.count, bounds(s.positions, 3)),
    JOINTS_0: d.array(s.joints, U8, 'VEC4', s.count), WEIGHTS_0: d.array(s.weights, FLOAT, 'VEC4', s.count),
  },
  targets: [{ POSITION: d.array(s.moved, FLOAT, 'VEC3', s.count, bounds(s.moved, 3)) }],
  indices: d.array(s.indices, U16, 'SCALAR', s.indices.length),
})).glb());
// Sequential encoding keeps the order of vertices, which morph targets follow.
write('strip_draco.glb', stripFile((d, s) => {
  d.require('KHR_draco_mesh_compression');
  const { bytes, ids, points, faces } =
    dracoBytes(s, { method: 'sequential', speed: 5, bits: [16, 0, 0, 0], joints: s.joints, weights: s.weights });
  const accessor = (componentType, type, count) => d.json.accessors.push({ componentType, type, count }) - 1;
  return {
    ...plain(d),
    attributes: {
      POSITION: accessor(FLOAT, 'VEC3', points), JOINTS_0: accessor(U8, 'VEC4', points),
      WEIGHTS_0: accessor(FLOAT, 'VEC4', points),
    },
    targets: [{ POSITION: d.array(s.moved, FLOAT, 'VEC3', s.count, bounds(s.moved, 3)) }],
    indices: accessor(U16, 'SCALAR', 3 * faces),
    extensions: { KHR_draco_mesh_compression: { bufferView: d.view(bytes), attributes: ids } },
  };
}).glb());
const stripMeshopt = stripFile((d, s) => {
  const EXT = 'EXT_meshopt_compression';
  const view = (bytes, count, stride, filter, vertices) =>
    d.compressed(EXT, { bytes, count, stride, mode: 'ATTRIBUTES', filter }, vertices);
  const exponential = (values, count) => MeshoptEncoder.encodeFilterExp(values, count, 12, 15, 'SharedVector');
  // The target is sparse: its indices and its values are compressed views as well.
  const places = Uint16Array.from({ length: s.count - 4 }, (_, i) => i + 2);
  const sparse = {
    count: places.length,
    indices: {
      bufferView: d.compressed(EXT, { bytes: bytesOf(places), count: places.length, stride: 2, mode: 'INDICES' }),
      componentType: U16,
    },
    values: { bufferView: view(exponential(s.moved.slice(6, -6), places.length), places.length, 12, 'EXPONENTIAL') },
  };
  const target = d.json.accessors.push({ componentType: FLOAT, type: 'VEC3', count: s.count, sparse }) - 1;
  const rotations = view(MeshoptEncoder.encodeFilterQuat(quaternions, keys, 8, 14), keys, 8, 'QUATERNION');
  return {
    times: d.accessor(view(bytesOf(times), keys, 4), FLOAT, 'SCALAR', keys, bounds(times, 1)),
    rotations: d.accessor(rotations, SHORT, 'VEC4', keys, { normalized: true }),
    bind: d.accessor(view(bytesOf(binds), 2, 64), FLOAT, 'MAT4', 2),
    attributes: {
      POSITION: d.accessor(view(exponential(s.positions, s.count), s.count, 12, 'EXPONENTIAL', true), FLOAT, 'VEC3', s.count),
      JOINTS_0: d.accessor(view(s.joints, s.count, 4, undefined, true), U8, 'VEC4', s.count),
      WEIGHTS_0: d.accessor(view(bytesOf(s.weights), s.count, 16, undefined, true), FLOAT, 'VEC4', s.count),
    },
    targets: [{ POSITION: target }],
    indices: d.accessor(
      d.compressed(EXT, { bytes: bytesOf(s.indices), count: s.indices.length, stride: 2, mode: 'TRIANGLES' }),
      U16, 'SCALAR', s.indices.length),
  };
}).glb();
write('strip_meshopt.glb', stripMeshopt);

// The same mesh through glTF Transform, as its users write files.
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS).registerDependencies({
  'draco3d.encoder': dracoEncoder, 'draco3d.decoder': dracoDecoder,
  'meshopt.encoder': MeshoptEncoder, 'meshopt.decoder': MeshoptDecoder,
});
for (const [name, transform] of [
  ['transform_draco.glb', draco({ quantizationVolume: 'mesh' })],
  ['transform_meshopt.glb', meshopt({ encoder: MeshoptEncoder, level: 'high' })],
]) {
  const document = await io.readBinary(raw(mesh).glb());
  document.setLogger({ debug() {}, info() {}, warn() {}, error() {} });
  await document.transform(transform);
  write(name, await io.writeBinary(document));
}

// Small files for the fuzzer.
const small = torus(5, 4);
const corpus = '../../corpus/gltf/';
write(`${corpus}draco_edgebreaker.glb`, dracoFile(small, { method: 'edgebreaker', speed: 0, bits: coarse }).glb());
write(`${corpus}draco_standard.glb`, dracoFile(small, { method: 'edgebreaker', speed: 7, bits: fine }).glb());
write(`${corpus}draco_sequential.glb`, dracoFile(small, { method: 'sequential', speed: 3, bits: coarse }).glb());
write(`${corpus}draco_bitstream_2_1.glb`,
  dracoFile(small, {
    method: 'edgebreaker', speed: 3, bits: coarse, module: oldEncoder, colors: floatColors(small),
  }).glb());

write(`${corpus}meshopt_filters.glb`, meshoptFile(small, 'KHR_meshopt_compression', 1, false, true).glb());
write(`${corpus}meshopt_strip.glb`, stripMeshopt);

// Streams of each mode, version and filter.
const random = (() => { let state = 1; return () => (state = (state * 48271) % 2147483647) / 2147483647; })();
const walk = (Type, count, width, step) => {
  const values = new Type(count * width);
  for (let i = 0; i < values.length; i++) values[i] = (values[i - width] ?? 0) + Math.round((random() - 0.4) * step);
  return values;
};
const attributes = (values, count, stride) => ({ bytes: bytesOf(values), count, stride, mode: 'ATTRIBUTES' });
for (const version of [0, 1]) {
  const of = (name, values, count, stride, level) =>
    keep(`${name}, version ${version}`, { ...attributes(values, count, stride), version }, level);
  of('one element', new Uint8Array([1, 2, 250, 0]), 1, 4, 3);
  of('bytes', walk(Uint8Array, 100, 4, 12), 100, 4, 3);
  of('noise', Uint8Array.from({ length: 8 * 40 }, () => 256 * random()), 40, 8, 3);
  of('halves', walk(Int16Array, 120, 4, 300), 120, 8, 3);
  of('floats', Float32Array.from({ length: 3 * 30 }, (_, i) => Math.sin(i / 9)), 30, 12, 3);
  of('wide elements', walk(Uint32Array, 34, 64, 9), 34, 256, 2);
  const fields = new Uint32Array(64);
  for (let i = 1; i < 64; i++) fields[i] = fields[i - 1] ^ (Math.floor(random() * 16) << 14);
  of('bit fields', fields, 64, 4, 3);
  of('blocks', walk(Uint8Array, 300, 4, 2), 300, 4, 1);
}
keep('torus', { bytes: bytesOf(small.indices), count: small.indices.length, stride: 2, mode: 'TRIANGLES' });
const scattered = Uint32Array.from({ length: 90 }, () => 70000 * random());
keep('scattered triangles', { bytes: bytesOf(scattered), count: 90, stride: 4, mode: 'TRIANGLES' });
const restarted = Uint16Array.from([...small.indices, ...small.indices]);
keep('triangles twice', { bytes: bytesOf(restarted), count: restarted.length, stride: 2, mode: 'TRIANGLES' });
keep('scattered indices', { bytes: bytesOf(scattered), count: 90, stride: 4, mode: 'INDICES' });
const zipped = Uint16Array.from({ length: 60 }, (_, i) => (i % 2 ? 40000 - i : i));
keep('two sequences', { bytes: bytesOf(zipped), count: 60, stride: 2, mode: 'INDICES' });
const directions = new Float32Array(4 * 32);
for (let i = 0; i < 32; i++) {
  const [z, a] = [1 - 2 * (i + 0.5) / 32, 2.4 * i], r = Math.sqrt(1 - z * z);
  directions.set([r * Math.cos(a), r * Math.sin(a), z, i % 2 ? 1 : -1], 4 * i);
}
const filtered = (name, bytes, count, stride, filter, version) =>
  keep(name, { bytes, count, stride, mode: 'ATTRIBUTES', filter, version });
for (const bits of [4, 8]) {
  filtered(`octahedral, ${bits} bits`, MeshoptEncoder.encodeFilterOct(directions, 32, 4, bits), 32, 4, 'OCTAHEDRAL', 1);
}
for (const bits of [10, 16]) {
  filtered(`octahedral, ${bits} bits`, MeshoptEncoder.encodeFilterOct(directions, 32, 8, bits), 32, 8, 'OCTAHEDRAL', 0);
}
const turned = directions.map((c, i) => c * (i % 4 === 3 ? 0.5 : Math.sqrt(0.75)));
for (const bits of [6, 16]) {
  filtered(`quaternions, ${bits} bits`, MeshoptEncoder.encodeFilterQuat(turned, 32, 8, bits), 32, 8, 'QUATERNION', 0);
}
const numbers = Float32Array.from({ length: 96 }, (_, i) => (i % 7 - 3) * 10 ** (i % 17 - 8));
for (const mode of ['Separate', 'SharedVector', 'SharedComponent', 'Clamped']) {
  const bytes = MeshoptEncoder.encodeFilterExp(numbers, 32, 12, mode === 'Separate' ? 23 : 15, mode);
  filtered(`exponential, ${mode}`, bytes, 32, 12, 'EXPONENTIAL', 0);
}
const hues = Float32Array.from({ length: 4 * 32 }, (_, i) => (i % 4 === 3 ? 0.5 + i / 256 : random()));
for (const [stride, bits] of [[4, 5], [4, 8], [8, 10], [8, 16]]) {
  filtered(`color, ${bits} bits`, MeshoptEncoder.encodeFilterColor(hues, 32, stride, bits), 32, stride, 'COLOR', 1);
}
write('streams.json', new TextEncoder().encode(`[\n${streams.map((s) => JSON.stringify(s)).join(',\n')}\n]\n`));
console.log(written.join('\n'));
