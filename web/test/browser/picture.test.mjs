// SPDX-License-Identifier: Apache-2.0
// The browser's pictures are the C++ renderer's.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, makeCan, newPage, pictureOf, psnr, rendered, serve, settled, skip, threePictureOf } from './support.mjs';

const LEAST = 35; // dB, of every view
let can, server, chrome;

before(async () => {
  if (skip) return;
  can = makeCan();
  server = await serve({ files: can.dir });
  chrome = await launch();
});
after(async () => {
  await chrome?.close();
  server?.close();
});

test('five views of the viewer are those of slf render', { skip }, async (t) => {
  const page = await newPage(chrome);
  await page.goto(`${server.page}?src=/files/can.slf&background=808080&embed`);
  assert.equal(await settled(page), 'ready');
  for (const [i, view] of can.views.entries()) {
    const value = psnr(await pictureOf(page, view, can.size), can.pictures[i]);
    t.diagnostic(`view ${i}: ${value.toFixed(2)} dB`);
    assert.ok(value >= LEAST, `view ${i}: ${value} dB`);
  }
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('mean colours are those of slf render --diffuse-only, and differ from the light field', { skip }, async (t) => {
  const page = await newPage(chrome);
  await page.goto(`${server.page}?src=/files/can.slf&background=808080&embed&mean`);
  assert.equal(await settled(page), 'ready');
  const picture = await pictureOf(page, can.views[0], can.size);
  const value = psnr(picture, rendered(can.file, can.views[0], can.size, '--diffuse-only'));
  t.diagnostic(`${value.toFixed(2)} dB; to the light field ${psnr(picture, can.pictures[0]).toFixed(2)} dB`);
  assert.ok(value >= LEAST);
  assert.ok(psnr(picture, can.pictures[0]) < value - 3);
  await page.close();
});

test('five views of the three.js object are those of slf render', { skip }, async (t) => {
  const page = await newPage(chrome);
  await page.goto(`${server.three}?src=/files/can.slf`);
  await page.waitForFunction(() => window.ready || window.failed);
  assert.equal(await page.evaluate(() => String(window.failed)), 'undefined');
  for (const [i, view] of can.views.entries()) {
    const value = psnr(await threePictureOf(page, view, can.size), can.pictures[i]);
    t.diagnostic(`view ${i}: ${value.toFixed(2)} dB`);
    assert.ok(value >= LEAST, `view ${i}: ${value} dB`);
  }
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('in a scene of three.js meshes hide the light field and it hides meshes', { skip }, async () => {
  const page = await newPage(chrome);
  await page.goto(`${server.three}?src=/files/can.slf`);
  await page.waitForFunction(() => window.ready);
  const [front, behind, bare] = await page.evaluate(() => {
    const { field, renderer, THREE } = window,
      { centre, radius } = field.packed;
    const wall = new THREE.Mesh(
      new THREE.PlaneGeometry(radius / 2, radius / 2),
      new THREE.MeshBasicMaterial({ color: '#ff00ff', side: THREE.DoubleSide }),
    );
    const scene = new THREE.Scene(),
      camera = new THREE.PerspectiveCamera(30, 1, 0.1, 100);
    field.position.set(...centre.map((v) => -v));
    field.quaternion.identity();
    field.scale.setScalar(1);
    camera.position.set(0, -5 * radius, 0);
    camera.up.set(0, 0, 1);
    camera.lookAt(0, 0, 0);
    const pixel = (y, withField) => {
      wall.position.set(0, y, 0);
      wall.rotation.x = Math.PI / 2;
      scene.clear().add(wall);
      if (withField) scene.add(field);
      renderer.setPixelRatio(1);
      renderer.setSize(200, 200, false);
      renderer.render(scene, camera);
      const gl = renderer.getContext(),
        out = new Uint8Array(4);
      gl.readPixels(100, 100, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out);
      return [...out.slice(0, 3)].join();
    };
    return [pixel(-2 * radius, true), pixel(2 * radius, true), pixel(2 * radius, false)];
  });
  assert.equal(front, '255,0,255');
  assert.notEqual(behind, '255,0,255');
  assert.equal(bare, '255,0,255');
  await page.close();
});
