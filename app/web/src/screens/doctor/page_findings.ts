// SPDX-License-Identifier: Apache-2.0
// What the page knows of itself: how it draws, how it came here, how far away the daemon is.
import type {Schemas} from '../../api/client';

export type Finding = Schemas['Doctor']['findings'][number];

function drawing(): Finding {
  const part = 'drawing';
  const context = document.createElement('canvas').getContext('webgl2');
  if (!context) {
    return {part, verdict: 'warning', says: 'This browser has no WebGL 2: the daemon draws what the viewer shows, more slowly.', remedy: 'Switch on hardware acceleration in the settings of the browser.'};
  }
  const names = context.getExtension('WEBGL_debug_renderer_info');
  const renderer = String(context.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : context.RENDERER));
  context.getExtension('WEBGL_lose_context')?.loseContext();
  const isSoftware = /swiftshader|llvmpipe|software/i.test(renderer);
  return {part, verdict: 'fine', says: `WebGL 2 by ${renderer}${isSoftware ? ', without a graphics processor' : ''}.`, remedy: ''};
}

function origin(): Finding {
  const part = 'origin';
  if (isSecureContext) return {part, verdict: 'fine', says: `The page came from ${location.origin}, which the browser trusts.`, remedy: ''};
  return {part, verdict: 'warning', says: `The page came from ${location.origin} without encryption: each tab listens for itself, and copying is done the old way.`, remedy: `ssh -L ${location.port}:localhost:${location.port} ${location.hostname}`};
}

const slow_ms = 200;

function distance(roundTrip_ms: number): Finding {
  const says = `The daemon answers within ${Math.ceil(roundTrip_ms)} ms.`;
  return {part: 'distance', verdict: roundTrip_ms > slow_ms ? 'warning' : 'fine', says, remedy: roundTrip_ms > slow_ms ? 'Maps come slowly over this network: use a cable.' : ''};
}

export function findingsOfPage(roundTrip_ms: number): Finding[] {
  return [drawing(), origin(), distance(roundTrip_ms)];
}
