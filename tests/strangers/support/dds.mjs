// SPDX-License-Identifier: Apache-2.0
// The header of a DDS file, by Microsoft's description: enough to hand its blocks to a graphics library.

const ofFourCc = {DXT1: 'bc1', DXT5: 'bc3', ATI1: 'bc4', BC4U: 'bc4', ATI2: 'bc5', BC5U: 'bc5'};
const ofDxgi = {71: 'bc1', 72: 'bc1', 77: 'bc3', 78: 'bc3', 80: 'bc4', 83: 'bc5', 98: 'bc7', 99: 'bc7'};
const srgbDxgi = [72, 78, 99];

export const blockBytes = {bc1: 8, bc3: 16, bc4: 8, bc5: 16, bc7: 16};

export function bytesOfLevel(format, width, height) {
  return Math.ceil(width / 4) * Math.ceil(height / 4) * blockBytes[format];
}

/** {format, srgb, dx10, width, height, levels, start}; throws where the file is none or its length is another. */
export function headerOf(bytes) {
  if (bytes.toString('latin1', 0, 4) !== 'DDS ' || bytes.readUInt32LE(4) !== 124) throw new Error('no DDS header');
  const height = bytes.readUInt32LE(12);
  const width = bytes.readUInt32LE(16);
  const levels = Math.max(1, bytes.readUInt32LE(28));
  const fourCc = bytes.toString('latin1', 84, 88);
  const dx10 = fourCc === 'DX10';
  const format = dx10 ? ofDxgi[bytes.readUInt32LE(128)] : ofFourCc[fourCc];
  if (!format) throw new Error(`a format of nobody: ${fourCc}`);
  const start = dx10 ? 148 : 128;
  let wanted = start;
  for (let level = 0; level < levels; level += 1) wanted += bytesOfLevel(format, Math.max(1, width >> level), Math.max(1, height >> level));
  if (wanted !== bytes.length) throw new Error(`${bytes.length} bytes, not ${wanted}`);
  return {format, srgb: dx10 && srgbDxgi.includes(bytes.readUInt32LE(128)), dx10, width, height, levels, start};
}
