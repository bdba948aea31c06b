// SPDX-License-Identifier: Apache-2.0
// .dds: WebGL in Chromium is the arbiter of the blocks; Pillow and OpenImageIO read what each of them can.
import fs from 'node:fs';
import path from 'node:path';
import {difference, withoutPadding} from '../support/compare.mjs';
import {bytesOfLevel, headerOf} from '../support/dds.mjs';
import {judgeFile} from './images.mjs';
import {readPixels} from '../support/pixels.mjs';
import {below} from '../support/report.mjs';

const byWebGl = `
const formats = {
  bc1: ['WEBGL_compressed_texture_s3tc', 'COMPRESSED_RGBA_S3TC_DXT1_EXT'], bc3: ['WEBGL_compressed_texture_s3tc', 'COMPRESSED_RGBA_S3TC_DXT5_EXT'],
  bc4: ['EXT_texture_compression_rgtc', 'COMPRESSED_RED_RGTC1_EXT'], bc5: ['EXT_texture_compression_rgtc', 'COMPRESSED_RED_GREEN_RGTC2_EXT'],
  bc7: ['EXT_texture_compression_bptc', 'COMPRESSED_RGBA_BPTC_UNORM_EXT'],
};
const gl = document.createElement('canvas').getContext('webgl2', {preserveDrawingBuffer: true, premultipliedAlpha: false});
function shader(kind, text) {
  const made = gl.createShader(kind);
  gl.shaderSource(made, text);
  gl.compileShader(made);
  if (!gl.getShaderParameter(made, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(made));
  return made;
}
function prepare() {
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, '#version 300 es\\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0, 1); }'));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, '#version 300 es\\nprecision highp float; uniform sampler2D picture; out vec4 texel; void main() { texel = texelFetch(picture, ivec2(gl_FragCoord.xy), 0); }'));
  gl.linkProgram(program);
  gl.useProgram(program);
}
function decode(blocks, format, width, height) {
  const [extension, constant] = formats[format];
  const offered = gl.getExtension(extension);
  if (!offered) throw new Error('this WebGL has no ' + extension);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.compressedTexImage2D(gl.TEXTURE_2D, 0, offered[constant], width, height, 0, blocks);
  const wrong = gl.getError();
  if (wrong) throw new Error('WebGL error ' + wrong);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  const target = gl.createTexture(), frame = gl.createFramebuffer();
  const source = gl.getParameter(gl.TEXTURE_BINDING_2D);
  gl.bindTexture(gl.TEXTURE_2D, target);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, width, height);
  gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
  gl.bindTexture(gl.TEXTURE_2D, source);
  gl.viewport(0, 0, width, height);
  gl.drawArrays(gl.TRIANGLES, 0, 3);
  const texels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, texels);
  return texels;
}
function base64(bytes) {
  let text = '';
  for (let at = 0; at < bytes.length; at += 32768) text += String.fromCharCode(...bytes.subarray(at, at + 32768));
  return btoa(text);
}
async function work(tasks) {
  prepare();
  const out = [];
  for (const {address, format, width, height, start, length} of tasks) {
    try {
      const file = new Uint8Array(await (await fetch(address)).arrayBuffer());
      out.push({texels: base64(decode(file.subarray(start, start + length), format, width, height))});
    } catch (error) {
      out.push({error: String(error?.message ?? error)});
    }
  }
  return out;
}`;

const channelsOf = {bc1: 3, bc3: 4, bc4: 1, bc5: 2, bc7: 4};

/** Which of them reads which header, as found by trying: the others refuse or guess. */
function canRead(reader, {format, dx10, srgb}) {
  if (reader === 'pillow') return format === 'bc5' || format === 'bc7' || !dx10;
  return format === 'bc1' || format === 'bc3' ? !dx10 : !srgb;
}

/** All readers of a block agree: exactly on bc7, by the rounding of one step on bc4 and bc5, of two on colours of bc1 and bc3. */
function judgeAgreement(read, arbiter, {format}) {
  if (read.error) return {ok: false, says: read.error};
  const count = Math.min(channelsOf[format], 3);
  const channels = Array.from({length: count}, (_, channel) => [channel, channel]);
  return below(difference(read, arbiter, channels).most * 255, {bc7: 0.01, bc4: 1.01, bc5: 1.01}[format] ?? 2.01, ' / 255', ' from WebGL at most');
}

function headers(report, files) {
  const known = new Map();
  for (const file of files) {
    try {
      known.set(file, headerOf(fs.readFileSync(file)));
    } catch (error) {
      report.check(`${path.basename(file)} its header`, {ok: false, says: error.message});
    }
  }
  return known;
}

/** Texels of the largest level of each file by WebGL; `offset` bytes too far for a twin. */
async function throughWebGl(browser, known, offset = 0) {
  const tasks = [...known].map(([file, {format, width, height, start}]) => ({address: browser.address(file), format, width, height, start: start + offset, length: bytesOfLevel(format, width, height)}));
  const {result} = await browser.run(byWebGl, tasks);
  return new Map([...known.keys()].map((file, at) => {
    const {texels, error} = result[at];
    if (error) return [file, {error}];
    const {width, height} = known.get(file);
    return [file, {width, height, channels: 4, bits: 8, whole: true, data: Float32Array.from(Buffer.from(texels, 'base64'), (value) => value / 255)}];
  }));
}

function checkReaders({report, known, arbiter, shifted, entryOf}) {
  for (const reader of ['pillow', 'openimageio']) {
    const files = [...known].filter(([file, header]) => canRead(reader, header) && !arbiter.get(file).error).map(([file]) => file);
    const read = files.length ? readPixels(reader, files) : [];
    files.forEach((file, at) => {
      const title = entryOf(file)?.title ?? path.basename(file);
      report.check(`${title} ${known.get(file).format} by ${reader}`, judgeAgreement(read[at], arbiter.get(file), known.get(file)));
      if (!shifted.get(file)?.error) report.refuses(`${title} against blocks shifted by one, by ${reader}`, judgeAgreement(read[at], shifted.get(file), known.get(file)));
    });
  }
}

export async function check({report, files, entryOf, truth, browser, scratch}) {
  const known = headers(report, files);
  const cut = path.join(scratch, 'cut.dds');
  const first = fs.readFileSync(files[0]);
  fs.writeFileSync(cut, first.subarray(0, 200));
  for (const reader of ['pillow', 'openimageio']) {
    const [read] = readPixels(reader, [cut]);
    report.refuses(`${path.basename(files[0])} cut short, by ${reader}`, {ok: !read.error, says: read.error ?? 'texels'});
  }
  if (!browser) return report.skip('blocks', 'WebGL is their arbiter');
  const arbiter = await throughWebGl(browser, known);
  const shifted = await throughWebGl(browser, known, -16);
  for (const [file, texels] of arbiter) {
    const entry = entryOf(file);
    if (texels.error) report.check(`${path.basename(file)} by WebGL`, {ok: false, says: texels.error});
    else if (entry) judgeFile({report, entry, texels: withoutPadding(texels, truth), truth, reader: 'WebGL'});
  }
  checkReaders({report, known, arbiter, shifted, entryOf});
  return undefined;
}
