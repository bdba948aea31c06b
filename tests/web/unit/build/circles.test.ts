// SPDX-License-Identifier: Apache-2.0
// Files of the page import each other in one direction, their types too: whoever reads one need not know who reads it.
import fs from 'node:fs';
import {createRequire} from 'node:module';
import path from 'node:path';
import {fileURLToPath} from 'node:url';
import type typescript from 'typescript';
import {expect, test} from 'vitest';

const page = new URL('../../../../app/web/', import.meta.url);
const ts: typeof typescript = createRequire(page)('typescript');
const source = fileURLToPath(new URL('src/', page));
const files = fs.readdirSync(source, {recursive: true, encoding: 'utf8'}).filter((file) => /\.tsx?$/.test(file)).sort();

/** What a file names by import or export from, by import() and by the type import('...'). */
function namedIn(file: string, text: string): string[] {
  const named: string[] = [];
  const visit = (node: typescript.Node): void => {
    const name =
      ts.isImportDeclaration(node) || ts.isExportDeclaration(node) ? node.moduleSpecifier :
      ts.isCallExpression(node) && node.expression.kind === ts.SyntaxKind.ImportKeyword ? node.arguments[0] :
      ts.isImportTypeNode(node) && ts.isLiteralTypeNode(node.argument) ? node.argument.literal : undefined;
    if (name && ts.isStringLiteralLike(name) && name.text.startsWith('.')) named.push(name.text);
    ts.forEachChild(node, visit);
  };
  visit(ts.createSourceFile(file, text, ts.ScriptTarget.Latest));
  return named;
}

/** The file of the page that another names; null: it is a style. */
function found(name: string, from: string): string | null {
  const base = path.join(path.dirname(from), name);
  const file = [base, `${base}.ts`, `${base}.tsx`, `${base}.d.ts`].find((candidate) => files.includes(candidate));
  if (!file && !fs.existsSync(path.join(source, base))) throw new Error(`${from} imports ${name}, which is not there`);
  return file ?? null;
}

/** Each circle once, from the file where a walk came upon it and back to it. */
function circlesOf(imports: Map<string, string[]>): string[] {
  const circles: string[] = [];
  const left = new Set<string>();
  const way: string[] = [];
  const walk = (file: string): void => {
    if (way.includes(file)) circles.push([...way.slice(way.indexOf(file)), file].join(' > '));
    if (way.includes(file) || left.has(file)) return;
    way.push(file);
    imports.get(file)?.forEach(walk);
    left.add(way.pop()!);
  };
  [...imports.keys()].forEach(walk);
  return circles;
}

/** Read before the tests, whose time is limited. */
const imports = new Map(files.map((file) => {
  const named = namedIn(file, fs.readFileSync(path.join(source, file), 'utf8'));
  return [file, named.flatMap((name) => found(name, file) ?? [])];
}));

test('a circle is found, and a file that two import is none', () => {
  expect(circlesOf(new Map([['a', ['b', 'c']], ['b', ['d']], ['c', ['d']], ['d', []]]))).toEqual([]);
  expect(circlesOf(new Map([['a', ['b']], ['b', ['c', 'd']], ['c', ['b']], ['d', ['d']]]))).toEqual(['b > c > b', 'd > d']);
});

test('every way to import is seen', () => {
  const text = "import './a.css'; import type {A} from './a'; export * from './b'; type C = import('./c').C; const d = () => import('./d'); import 'e';";
  expect(namedIn('f.ts', text)).toEqual(['./a.css', './a', './b', './c', './d']);
});

test('no file of the page imports itself by way of others', () => {
  expect(imports.get('main.tsx')).toContain('frame/frame.tsx');
  expect(circlesOf(imports)).toEqual([]);
});
