// SPDX-License-Identifier: Apache-2.0
// A .glb as its JSON and its buffer, and back: for twins.

export function takeApart(bytes) {
  const length = bytes.readUInt32LE(12);
  return {json: JSON.parse(bytes.subarray(20, 20 + length).toString()), buffer: bytes.subarray(28 + length)};
}

function padded(bytes, filler) {
  return Buffer.concat([bytes, Buffer.alloc((4 - (bytes.length % 4)) % 4, filler)]);
}

function header(length, type) {
  const out = Buffer.alloc(8);
  out.writeUInt32LE(length, 0);
  out.write(type, 4, 'latin1');
  return out;
}

export function putTogether({json, buffer}) {
  const text = padded(Buffer.from(JSON.stringify(json)), ' ');
  const body = padded(buffer, 0);
  const head = Buffer.alloc(12);
  head.write('glTF', 0, 'latin1');
  head.writeUInt32LE(2, 4);
  head.writeUInt32LE(28 + text.length + body.length, 8);
  return Buffer.concat([head, header(text.length, 'JSON'), text, header(body.length, 'BIN\0'), body]);
}

export function imageOfTexture({json, buffer}, texture) {
  const {bufferView} = json.images[json.textures[texture].source];
  const {byteOffset = 0, byteLength} = json.bufferViews[bufferView];
  return buffer.subarray(byteOffset, byteOffset + byteLength);
}

/** Another image behind a texture, put at the end of the buffer. */
export function withImage({json, buffer}, texture, image) {
  const other = structuredClone(json);
  const start = padded(buffer, 0);
  const view = other.bufferViews[other.images[other.textures[texture].source].bufferView];
  view.byteOffset = start.length;
  view.byteLength = image.length;
  const whole = Buffer.concat([start, image]);
  other.buffers[0].byteLength = whole.length;
  return {json: other, buffer: whole};
}

/** Without extensions of the material, holes and mixing: what is left has its normals in Blender's pass unmixed. */
export function plain({json, buffer}) {
  const other = structuredClone(json);
  for (const material of other.materials) {
    delete material.extensions;
    delete material.alphaMode;
    delete material.alphaCutoff;
  }
  return {json: other, buffer};
}
