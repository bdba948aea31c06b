// SPDX-License-Identifier: Apache-2.0
// sbom.mjs VERSION SOURCE PROGRAM...: the bill of materials of these programs in CycloneDX 1.5, on standard output:
// Debian packages of the shared libraries that they name, those that they hold (headers and static libraries), and
// the packages of npm that the page holds. The same programs on the same Debian give the same bytes.
import { execFileSync, spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { existsSync, readFileSync, realpathSync } from 'node:fs';
import { join } from 'node:path';

// Debian packages that leave something in the programs and are not named by them.
const HELD = ['libceres-dev', 'libcli11-dev', 'libeigen3-dev', 'libkissfft-dev', 'nlohmann-json3-dev'];

const [version, source, ...programs] = process.argv.slice(2);
if (programs.length === 0) {
  console.error('sbom.mjs VERSION SOURCE PROGRAM...');
  process.exit(64);
}
const run = (command, ...words) => execFileSync(command, words, { encoding: 'utf8', maxBuffer: 1 << 26 });

// The file that each name of a NEEDED entry is on this machine.
function filesOfNames() {
  const files = new Map();
  for (const line of run('/sbin/ldconfig', '-p').split('\n')) {
    const found = /^\t(\S+) \(.*x86-64.*\) => (\S+)$/.exec(line) ?? /^\t(\S+) \(.*\) => (\S+)$/.exec(line);
    if (found && !files.has(found[1])) files.set(found[1], found[2]);
  }
  return files;
}

const needed = (program) =>
  [...run('readelf', '-d', program).matchAll(/\(NEEDED\)\s+Shared library: \[(.*)\]/g)].map((found) => found[1]);

// The packages of files. dpkg knows a file by the path that it was packed with, before or after /usr was merged.
function packagesOfFiles(paths) {
  const names = (path) => {
    const merged = [path, realpathSync(path)].map((each) => each.replace(/^\/usr\//, '/'));
    return merged.flatMap((each) => [each, `/usr${each}`]);
  };
  // It fails for names that it does not know, and tells of the others all the same.
  const { stdout } = spawnSync('dpkg-query', ['-S', ...paths.flatMap(names)], { encoding: 'utf8', maxBuffer: 1 << 26 });
  const packages = new Map(stdout.trim().split('\n').map((line) => line.split(': ').reverse()));
  return paths.map((path) => {
    const known = names(path).find((each) => packages.has(each));
    if (!known) throw new Error(`no Debian package has ${path}`);
    return packages.get(known);
  });
}

function debianComponent(name, how) {
  const [plain, version, architecture, sourceName] = run(
    'dpkg-query', '-W', '-f', '${Package}\t${Version}\t${Architecture}\t${source:Package}', name).split('\t');
  return {
    'bom-ref': `pkg:deb/debian/${plain}@${version}`,
    type: 'library',
    name: plain,
    version,
    purl: `pkg:deb/debian/${plain}@${encodeURIComponent(version)}?arch=${architecture}&distro=debian-12`,
    properties: [{ name: 'weft:linked', value: how }, { name: 'debian:source', value: sourceName }],
  };
}

function npmComponents() {
  const lock = JSON.parse(readFileSync(join(source, 'app/web/package-lock.json'), 'utf8'));
  return Object.entries(lock.packages)
    .filter(([path, entry]) => path !== '' && !entry.dev)
    .map(([path, entry]) => {
      const name = path.replace(/^.*node_modules\//, '');
      const component = {
        'bom-ref': `pkg:npm/${name}@${entry.version}`,
        type: 'library',
        name,
        version: entry.version,
        licenses: [{ license: { id: entry.license } }],
        purl: `pkg:npm/${name.replace('@', '%40')}@${entry.version}`,
        properties: [{ name: 'weft:linked', value: 'held by the page' }],
      };
      if (entry.integrity) {
        const [algorithm, digest] = entry.integrity.split('-');
        const alg = { sha512: 'SHA-512', sha256: 'SHA-256' }[algorithm];
        component.hashes = [{ alg, content: Buffer.from(digest, 'base64').toString('hex') }];
      }
      return component;
    });
}

const files = filesOfNames();
const names = [...new Set(programs.flatMap(needed))];
for (const name of names) {
  if (!files.has(name)) throw new Error(`${name} is not on this machine`);
}
const shared = new Set(packagesOfFiles(names.map((name) => files.get(name))));
const held = HELD.filter((name) => existsSync(`/var/lib/dpkg/info/${name}.list`));
const components = [
  ...[...shared].map((name) => debianComponent(name, 'shared')),
  ...held.map((name) => debianComponent(name, 'held')),
  ...npmComponents(),
].sort((a, b) => (a['bom-ref'] < b['bom-ref'] ? -1 : 1));

const self = `pkg:generic/weft@${version}`;
const hash = createHash('sha256').update(JSON.stringify(components)).digest('hex');
const uuid = `${hash.slice(0, 8)}-${hash.slice(8, 12)}-5${hash.slice(13, 16)}-8${hash.slice(17, 20)}-${hash.slice(20, 32)}`;
const bom = {
  $schema: 'http://cyclonedx.org/schema/bom-1.5.schema.json',
  bomFormat: 'CycloneDX',
  specVersion: '1.5',
  serialNumber: `urn:uuid:${uuid}`,
  version: 1,
  metadata: {
    component: {
      'bom-ref': self,
      type: 'application',
      name: 'weft',
      version,
      licenses: [{ license: { id: 'Apache-2.0' } }],
      purl: self,
    },
  },
  components,
  dependencies: [{ ref: self, dependsOn: components.map((each) => each['bom-ref']) }],
};
process.stdout.write(`${JSON.stringify(bom, null, 2)}\n`);
