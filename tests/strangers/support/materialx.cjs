// SPDX-License-Identifier: Apache-2.0
// materialx.cjs FILE...: a line of JSON a file, by MaterialX itself: whether the document is valid, its nodes, how
// much GLSL it makes, what its images are. The package's script is made for pages, so its export line is cut off.
const fs = require('node:fs');
const os = require('node:os');
const path = require('node:path');

const bin = path.join(__dirname, '../node_modules/@needle-tools/materialx/bin');
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'weft-materialx-'));
const script = path.join(folder, 'materialx.cjs');
fs.writeFileSync(script, fs.readFileSync(path.join(bin, 'JsMaterialXGenShader.js'), 'utf8').replace(/^export default .*$/m, ''));

function data() {
  const bytes = fs.readFileSync(path.join(bin, 'JsMaterialXGenShader.data.txt'));
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
}

function imagesOf(nodes) {
  const value = (node, name) => node.getInput(name)?.getValueString() ?? '';
  return nodes.filter((node) => ['image', 'tiledimage'].includes(node.getCategory())).map((node) => ({
    name: node.getName(), file: value(node, 'file'), colorspace: node.getInput('file')?.getColorSpace() ?? '',
    imageSize: value(node, 'realworldimagesize'), tileSize: value(node, 'realworldtilesize'),
    unit: node.getInput('realworldimagesize')?.getUnit() ?? '',
  }));
}

async function read(mx, context, generator, library, file) {
  const document = mx.createDocument();
  await mx.readFromXmlString(document, fs.readFileSync(file, 'utf8'), '');
  const nodes = [...document.getNodes(), ...document.getNodeGraphs().flatMap((graph) => [...graph.getNodes()])];
  const facts = {nodes: nodes.length, categories: nodes.map((node) => node.getCategory()), images: imagesOf(nodes), shaders: []};
  document.setDataLibrary(library);
  const said = {};
  const ok = document.validate(said);
  Object.assign(facts, {ok, says: said.message ?? ''});
  if (!ok) return facts;
  for (const material of document.getMaterialNodes()) {
    const shader = generator.generate('weft', material, context);
    facts.shaders.push(shader.getSourceCode('pixel').length);
  }
  return facts;
}

require(script)({locateFile: (file) => path.join(bin, file), getPreloadedPackage: data}).then(async (mx) => {
  fs.rmSync(folder, {recursive: true});
  const generator = mx.EsslShaderGenerator.create();
  const context = new mx.GenContext(generator);
  const library = mx.loadStandardLibraries(context);
  for (const file of process.argv.slice(2)) {
    let facts;
    try {
      facts = await read(mx, context, generator, library, file);
    } catch (error) {
      facts = {ok: false, says: typeof error === 'number' ? mx.getExceptionMessage(error) : String(error?.message ?? error)};
    }
    process.stdout.write(`${JSON.stringify(facts)}\n`);
  }
  process.exit(0);
});
