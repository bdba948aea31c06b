// SPDX-License-Identifier: Apache-2.0
// .u3m and .u3ma: ajv holds the document against the schema of U3M 1.1, Pillow its constants against the textures,
// zipinfo and the records of the zip its container. WEFT_U3M_SCHEMA names another schema, such as upstream's own.
import fs from 'node:fs';
import path from 'node:path';
import Ajv from 'ajv';
import formats from 'ajv-formats';
import {linearOfSrgb, srgbOfLinear} from '../support/compare.mjs';
import {judgeAlbedo, judgeNormals} from '../support/judges.mjs';
import {readPixels} from '../support/pixels.mjs';
import {byExitCode, has, here, python, run} from '../support/programs.mjs';
import {all, below, sameLength} from '../support/report.mjs';
import {entriesOf} from '../support/zip.mjs';

function schema() {
  const file = process.env.WEFT_U3M_SCHEMA ?? path.join(here, 'u3m_1_1.schema.json');
  const text = JSON.parse(fs.readFileSync(file, 'utf8'));
  delete text.$schema;
  const ajv = new Ajv({strict: false, allErrors: true});
  formats(ajv);
  return ajv.compile(text);
}

function judgeDocument(validate, document) {
  const ok = validate(document);
  return {ok, says: ok ? 'valid' : validate.errors.slice(0, 3).map(({instancePath, message}) => `${instancePath} ${message}`).join('; ')};
}

function texturesOf({material}) {
  return Object.entries(material.front ?? {}).filter(([, value]) => value?.texture).map(([name, {constant, texture}]) => ({name, constant, ...texture}));
}

/** Millimetres of each image, and a resolution that agrees with them and with its pixels. */
function judgeSize(document, pixels, size_mm) {
  return all(texturesOf(document).flatMap(({image}, at) => {
    const {width, height} = pixels[at];
    return [
      sameLength(image.width, size_mm[0], 1e-6), sameLength(image.height, size_mm[1], 1e-6),
      sameLength(image.dpi.x, (width / size_mm[0]) * 25.4, 1e-6, 'dpi'), sameLength(image.dpi.y, (height / size_mm[1]) * 25.4, 1e-6, 'dpi'),
    ];
  }));
}

function meanOf({data, channels, width, height}, channel, of = (value) => value) {
  let sum = 0;
  for (let at = channel; at < data.length; at += channels) sum += of(data[at]);
  return sum / (width * height);
}

/** A constant is the mean of its texture, for programs without textures; a colour's is averaged in linear light and written in sRGB. */
function judgeConstants(document, pixels) {
  return all(texturesOf(document).map(({name, constant, factor, offset}, at) => {
    let off;
    if (name === 'basecolor') off = Math.max(...['r', 'g', 'b'].map((key, channel) => Math.abs(constant[key] - srgbOfLinear(meanOf(pixels[at], channel, linearOfSrgb)))));
    else if (typeof constant === 'number') off = Math.abs(constant - (offset + factor * meanOf(pixels[at], 0)));
    else return {ok: true, says: `${name} is a direction`};
    return below(off, 0.002, '', ` of ${name} from the mean of its texture`);
  }));
}

function twins(document) {
  const twin = (change) => {
    const other = structuredClone(document);
    change(other.material);
    return other;
  };
  return {
    'alpha 2': twin((material) => { material.front.alpha.constant = 2; }),
    'a weave of nobody': twin((material) => { material.physics = {...(material.physics ?? {thickness: null, weight: null, composition: null, material_type: null, devices: {fab: 'null'}}), construction: {type: 'Taffeta', name: null}}; }),
    'a texture outside': twin((material) => { texturesOf({material})[0].image.path = '../normal.png'; }),
    'a member too many': twin((material) => { material.front.fuzz = 1; }),
    'no shader': twin((material) => { delete material.front.shader; }),
    'an id of another kind': twin((material) => { material.id = material.id.replace(/^(.{14})4/, '$11'); }),
  };
}

/** Flags, versions and names as the specification of U3MA has them. */
export function judgeArchive(bytes) {
  const entries = entriesOf(bytes);
  return all(entries.flatMap(({name, madeBy, needed, flags, method, extra, localExtra, comment, external}) => [
    {ok: (madeBy === 0x3f || madeBy === 0x003f) && needed === 0x14, says: `made by ${madeBy.toString(16)}, needs ${needed.toString(16)}`},
    {ok: flags === 0x0800, says: `flags ${flags.toString(16)}`},
    {ok: method === 0 || method === 8, says: 'stored or deflated'},
    {ok: extra === 0 && localExtra === 0 && comment === 0 && external === 0, says: 'no extra fields, comments, attributes'},
    {ok: !/^\/|\\|\.\./.test(name), says: 'names are relative'},
  ]));
}

async function checkDocument({report, validate, file, document, folder, size_mm, truth}) {
  const name = path.basename(file);
  report.check(`${name} by ajv`, judgeDocument(validate, document));
  for (const [what, twin] of Object.entries(twins(document))) report.refuses(`${name} with ${what}, by ajv`, judgeDocument(validate, twin));
  const textures = texturesOf(document);
  const pixels = readPixels('openimageio', textures.map(({image}) => path.join(folder, image.path)));
  const refused = pixels.findIndex(({error}) => error);
  if (refused >= 0) return report.check(`${name} its textures`, {ok: false, says: `${textures[refused].image.path}: ${pixels[refused].error}`});
  if (size_mm) {
    report.check(`${name} size and resolution`, judgeSize(document, pixels, size_mm));
    const twin = structuredClone(document);
    texturesOf(twin)[0].image.dpi.x *= 1.0001;
    report.refuses(`${name} with a resolution of another size`, judgeSize(twin, pixels, size_mm));
  }
  report.check(`${name} its constants`, judgeConstants(document, pixels));
  const twin = structuredClone(document);
  twin.material.front.basecolor.constant.r += 0.01;
  report.refuses(`${name} with a constant of another colour`, judgeConstants(twin, pixels));
  const at = (wanted) => pixels[textures.findIndex((texture) => texture.name === wanted)];
  if (truth.albedo && at('basecolor')) report.check(`${name} albedo by OpenImageIO`, judgeAlbedo(at('basecolor'), truth.albedo));
  if (truth.normal && at('normal')) {
    report.check(`${name} normals of ${at('normal').bits} bits by OpenImageIO`, judgeNormals(at('normal'), truth.normal));
    report.refuses(`${name} normals read with green flipped`, judgeNormals(at('normal'), truth.normal, {greenSign: -1}));
  }
  return undefined;
}

function checkArchive({report, file, scratch}) {
  const name = path.basename(file);
  report.check(`${name} its records`, judgeArchive(fs.readFileSync(file)));
  const twin = path.join(scratch, `python_${name}`);
  const script = 'import sys, zipfile\nold = zipfile.ZipFile(sys.argv[1])\nnew = zipfile.ZipFile(sys.argv[2], "w")\n[new.writestr(n, old.read(n)) for n in old.namelist()]\nnew.close()';
  const {code, err} = run(python, ['-c', script, file, twin]);
  if (code !== 0) throw new Error(err);
  report.refuses(`${name} as Python writes zips`, judgeArchive(fs.readFileSync(twin)));
  if (!has('unzip')) return report.skip(`${name} by unzip`, 'there is no unzip');
  report.check(`${name} by unzip`, byExitCode('unzip', ['-tq', file]));
  const cut = path.join(scratch, `cut_${name}`);
  fs.writeFileSync(cut, fs.readFileSync(file).subarray(0, -40));
  report.refuses(`${name} cut short, by unzip`, byExitCode('unzip', ['-tq', cut]));
  const {out} = run('zipinfo', ['-v', file]);
  const said = (pattern) => pattern.test(out);
  return report.check(`${name} by zipinfo`, all([
    {ok: said(/minimum software version required to extract: +2\.0/), says: 'needs 2.0'},
    {ok: !said(/length of extra field: +[1-9]/), says: 'no extra fields'}, {ok: !said(/extended local header: +yes/), says: 'no data descriptors'},
  ]));
}

export async function check({report, files, size_mm, truth, scratch}) {
  const validate = schema();
  for (const file of files) {
    if (path.extname(file) === '.u3m') {
      await checkDocument({report, validate, file, document: JSON.parse(fs.readFileSync(file, 'utf8')), folder: path.dirname(file), size_mm, truth});
      continue;
    }
    checkArchive({report, file, scratch});
    const folder = fs.mkdtempSync(path.join(scratch, 'u3ma-'));
    for (const {name, bytes, method} of entriesOf(fs.readFileSync(file))) {
      if (method !== 0) throw new Error(`${name} in ${file} is deflated`);
      fs.mkdirSync(path.dirname(path.join(folder, name)), {recursive: true});
      fs.writeFileSync(path.join(folder, name), bytes);
    }
    const inside = fs.readdirSync(folder).find((name) => name.endsWith('.u3m'));
    if (!inside) report.check(path.basename(file), {ok: false, says: 'there is no .u3m inside'});
    else await checkDocument({report, validate, file, document: JSON.parse(fs.readFileSync(path.join(folder, inside), 'utf8')), folder, size_mm, truth});
  }
}
