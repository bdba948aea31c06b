// SPDX-License-Identifier: Apache-2.0
import fs from 'node:fs';
import {fileURLToPath} from 'node:url';
import {expect, test} from 'vitest';
import {types} from '../../../../app/web/tools/schema.mjs';

test('the types of the calls are those that the daemon describes', async () => {
  const kept = fs.readFileSync(fileURLToPath(new URL('../../../../app/web/src/api/schema.d.ts', import.meta.url)), 'utf8');
  expect(await types(), 'run npm run schema in app/web').toBe(kept);
});
