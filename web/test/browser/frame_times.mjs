// SPDX-License-Identifier: Apache-2.0
// What a frame of the viewer takes on this machine.
//   node web/test/browser/frame_times.mjs FILE.slf [pixels of a side, default 800]
// In full: milliseconds of a view that has changed, colours and all, until the graphics are done; least of ten. Turning:
// frames a second of the page as a person sees it, and how coarse they are.
import { basename, dirname, resolve } from 'node:path';
import { launch, newPage, serve, settled, skip } from './support.mjs';

const [file, side = '800'] = process.argv.slice(2);
if (skip || !file) {
  console.log(skip || 'a file is needed');
  process.exit(77);
}
const server = await serve({ files: dirname(resolve(file)) });
const chrome = await launch();
const page = await newPage(chrome, { viewport: { width: Number(side), height: Number(side) } });
await page.goto(`${server.page}?src=/files/${basename(file)}`);
console.log(await settled(page));
const measured = await page.evaluate(async () => {
  const { stage, controls } = window.viewer,
    { gl } = stage,
    pixel = new Uint8Array(4),
    times = [];
  for (let i = 0; i < 10; ++i) {
    controls.pose.azimuth += 3;
    const begin = performance.now();
    stage.draw();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits for what was asked for
    times.push(performance.now() - begin);
  }
  let frames = 0;
  const draw = stage.draw.bind(stage);
  stage.draw = (scale) => (++frames, draw(scale));
  window.viewer.spin(30);
  await new Promise((done) => setTimeout(done, 5000)); // until the resolution has settled
  frames = 0;
  const begin = performance.now();
  await new Promise((done) => setTimeout(done, 5000));
  const rate = (1000 * frames) / (performance.now() - begin);
  const names = gl.getExtension('WEBGL_debug_renderer_info');
  return {
    renderer: names && gl.getParameter(names.UNMASKED_RENDERER_WEBGL),
    points: stage.field.points,
    components: stage.field.components,
    full: Math.min(...times),
    rate,
    scale: stage.scale,
  };
});
console.log(`${measured.renderer}\n${measured.points} points of ${measured.components} components, ${side} x ${side}`);
console.log(`in full ${measured.full.toFixed(0)} ms; turning ${measured.rate.toFixed(1)} frames/s at ${measured.scale.toFixed(2)} of the resolution`);
await chrome.close();
server.close();
