// SPDX-License-Identifier: Apache-2.0
// .glb: Khronos' validator, three's loader in Chromium, and the texels that pngjs finds inside.
import fs from 'node:fs';
import path from 'node:path';
import validator from 'gltf-validator';
import {judgeAlbedo, judgeNormals} from '../support/judges.mjs';
import {greenFlipped, readPng, writePng} from '../support/pixels.mjs';
import {imageOfTexture, putTogether, takeApart, withImage} from '../support/glb.mjs';
import {all, below, sameLength} from '../support/report.mjs';

async function byValidator(bytes) {
  const {issues} = await validator.validateBytes(new Uint8Array(bytes), {maxIssues: 20});
  const words = issues.messages.filter(({severity}) => severity < 2).map(({code, pointer}) => `${code} ${pointer ?? ''}`);
  return {ok: issues.numErrors === 0 && issues.numWarnings === 0, says: [`${issues.numErrors} errors, ${issues.numWarnings} warnings`, ...words.slice(0, 3)].join('; ')};
}

const byThree = `
import * as THREE from 'three';
import {GLTFLoader} from 'three/addons/loaders/GLTFLoader.js';
async function read(address) {
  const {scene} = await new GLTFLoader().loadAsync(address);
  const size = new THREE.Box3().setFromObject(scene).getSize(new THREE.Vector3());
  let material;
  scene.traverse((part) => { material ??= part.material; });
  const of = (map) => map ? {colorSpace: map.colorSpace, width: map.image.width} : null;
  return {size_m: size.toArray(), map: of(material.map), normalMap: of(material.normalMap), roughnessMap: of(material.roughnessMap),
    sheenColorMap: of(material.sheenColorMap), sheen: material.sheen ?? 0, anisotropy: material.anisotropy ?? 0};
}
async function work(addresses) {
  const out = [];
  for (const address of addresses) out.push(await read(address).catch((error) => ({error: String(error?.message ?? error)})));
  return out;
}`;

/** What three makes of it: size in metres, colour as sRGB, data as they are. */
function judgeThree(read, size_mm) {
  if (read.error) return {ok: false, says: read.error};
  const verdicts = [];
  if (size_mm) size_mm.forEach((mm, axis) => verdicts.push(sameLength(read.size_m[axis] * 1000, mm, 1e-6)));
  if (read.map) verdicts.push({ok: read.map.colorSpace === 'srgb', says: `albedo as "${read.map.colorSpace}"`});
  for (const name of ['normalMap', 'roughnessMap']) {
    if (read[name]) verdicts.push({ok: read[name].colorSpace === '', says: `${name} as "${read[name].colorSpace}"`});
  }
  if (read.sheenColorMap) verdicts.push({ok: read.sheenColorMap.colorSpace === 'srgb' && read.sheen > 0, says: `sheen ${read.sheen} as "${read.sheenColorMap.colorSpace}"`});
  return all(verdicts);
}

function texelsOf(parts) {
  const material = parts.json.materials[0];
  const albedo = material.pbrMetallicRoughness.baseColorTexture?.index;
  const normal = material.normalTexture?.index;
  const read = (texture) => (texture === undefined ? null : readPng(imageOfTexture(parts, texture)));
  return {albedo: read(albedo), normal: read(normal), normalTexture: normal};
}

function twins(parts) {
  const dangling = structuredClone(parts.json);
  dangling.materials[0].normalTexture = {index: 99};
  const longer = structuredClone(parts.json);
  const positions = longer.accessors[longer.meshes[0].primitives[0].attributes.POSITION];
  positions.max = positions.max.map((value) => value * 1.001);
  return {'a normal texture that is not there': {...parts, json: dangling}, 'a size that is not the points\'': {...parts, json: longer}};
}

/** Ten thousandths more, in the points and in what is said of them: legal, and not this cloth's size. */
function scaled({json, buffer}) {
  const other = structuredClone(json);
  const accessor = other.accessors[other.meshes[0].primitives[0].attributes.POSITION];
  const view = other.bufferViews[accessor.bufferView];
  const bytes = Buffer.from(buffer);
  const start = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
  for (let at = 0; at < 3 * accessor.count; at += 1) {
    bytes.writeFloatLE(Math.fround(bytes.readFloatLE(start + 4 * at) * 1.001), start + 4 * at);
  }
  accessor.min = accessor.min.map((value) => Math.fround(value * 1.001));
  accessor.max = accessor.max.map((value) => Math.fround(value * 1.001));
  return {json: other, buffer: bytes};
}

export async function check({report, files, size_mm, truth, scratch, browser}) {
  const sizeTwins = [];
  for (const file of files) {
    const name = path.basename(file);
    const bytes = fs.readFileSync(file);
    report.check(`${name} by gltf-validator`, await byValidator(bytes));
    const parts = takeApart(bytes);
    for (const [what, twin] of Object.entries(twins(parts))) report.refuses(`${name} with ${what}, by gltf-validator`, await byValidator(putTogether(twin)));
    report.refuses(`${name} cut short, by gltf-validator`, await byValidator(bytes.subarray(0, bytes.length - 64)));
    const {albedo, normal, normalTexture} = texelsOf(parts);
    if (truth.albedo && albedo) report.check(`${name} albedo by pngjs`, judgeAlbedo(albedo, truth.albedo));
    if (truth.normal && normal) {
      report.check(`${name} normals of ${normal.bits} bits by pngjs`, judgeNormals(normal, truth.normal));
      const flipped = withImage(parts, normalTexture, writePng(greenFlipped(normal)));
      report.refuses(`${name} with green flipped`, judgeNormals(texelsOf(flipped).normal, truth.normal));
    }
    const twin = path.join(scratch, `scaled_${name}`);
    fs.writeFileSync(twin, putTogether(scaled(parts)));
    sizeTwins.push(twin);
  }
  if (!browser) return;
  const {result} = await browser.run(byThree, [...files, ...sizeTwins].map((file) => browser.address(file)));
  files.forEach((file, at) => {
    report.check(`${path.basename(file)} by three's GLTFLoader`, judgeThree(result[at], size_mm));
    if (size_mm) report.refuses(`${path.basename(file)} a thousandth larger, by three's GLTFLoader`, judgeThree(result[files.length + at], size_mm));
  });
}
