// SPDX-License-Identifier: Apache-2.0
// Files of Gaussian splats in the viewer's page, the three.js object and the one-file page: the C++ renderer's pictures.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { existsSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { launch, loseContext, makeSplats, newPage, pictureOf, psnr, readPng, rendered, serve, settled, skip, slf, threePictureOf, web } from './support.mjs';

const LEAST = 35; // dB, of every view
const MOST_BESIDE_FILE = 230_000; // bytes of a page
let splats, server, chrome;

before(async () => {
  if (skip) return;
  splats = makeSplats();
  writeFileSync(join(splats.dir, 'slow.slf'), splats.bytes);
  const chunk = Math.ceil(splats.bytes.length / 30);
  server = await serve({ files: splats.dir }, { 'slow.slf': { chunk, wait: 250 } });
  chrome = await launch();
});
after(async () => {
  await chrome?.close();
  server?.close();
});

/** A page that shows the splats. */
async function opened(more = '') {
  const page = await newPage(chrome);
  await page.goto(`${server.page}?src=/files/splats.slf&background=808080&embed${more}`);
  assert.equal(await settled(page), 'ready');
  return page;
}

function assertLike(t, what, picture, expected) {
  const value = psnr(picture, expected);
  t.diagnostic(`${what}: ${value.toFixed(2)} dB`);
  assert.ok(value >= LEAST, `${what}: ${value} dB`);
}

test('five views of the viewer are those of slf render', { skip }, async (t) => {
  const page = await opened();
  assert.equal(await page.evaluate(() => window.viewer.facts.info.hasSplats), true);
  for (const [i, view] of splats.views.entries())
    assertLike(t, `view ${i}`, await pictureOf(page, view, splats.size), splats.pictures[i]);
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('mean colours are those of slf render --diffuse-only', { skip }, async (t) => {
  const page = await opened('&mean'),
    picture = await pictureOf(page, splats.views[0], splats.size);
  assertLike(t, 'mean', picture, rendered(splats.file, splats.views[0], splats.size, '--diffuse-only'));
  assert.ok(psnr(picture, splats.pictures[0]) < LEAST);
  await page.close();
});

test('a share of the splats is drawn where that is asked for, and is like all of them', { skip }, async () => {
  const page = await opened('&points=25'),
    picture = await pictureOf(page, splats.views[0], splats.size);
  const [drawn, all] = await page.evaluate(() => [
    window.viewer.stage.pipeline.statistics.discs,
    window.viewer.stage.field.points,
  ]);
  assert.ok(drawn > 0 && drawn <= Math.round(all / 4), `${drawn} of ${all}`);
  const value = psnr(picture, splats.pictures[0]);
  assert.ok(value > 15 && value < 60, `${value} dB`);
  await page.close();
});

test('exposure brightens what is seen, not what is behind', { skip }, async () => {
  const page = await opened('&exposure=1'),
    { data } = await pictureOf(page, splats.views[0], splats.size),
    plain = splats.pictures[0].data;
  const sum = (bytes) => bytes.reduce((all, v) => all + v, 0);
  assert.ok(sum(data) > 1.05 * sum(plain));
  assert.deepEqual([...data.subarray(0, 3)], [128, 128, 128]);
  await page.close();
});

test('five views of the three.js object are those of slf render', { skip }, async (t) => {
  const page = await newPage(chrome);
  await page.goto(`${server.three}?src=/files/splats.slf`);
  await page.waitForFunction(() => window.ready || window.failed);
  assert.equal(await page.evaluate(() => String(window.failed)), 'undefined');
  for (const [i, view] of splats.views.entries())
    assertLike(t, `view ${i}`, await threePictureOf(page, view, splats.size), splats.pictures[i]);
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('in a scene of three.js meshes hide splats and they hide meshes; rays meet them', { skip }, async () => {
  const page = await newPage(chrome);
  await page.goto(`${server.three}?src=/files/splats.slf`);
  await page.waitForFunction(() => window.ready);
  const { pixels, met } = await page.evaluate(() => {
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
    const pixel = (y) => {
      wall.position.set(0, y, 0);
      wall.rotation.x = Math.PI / 2;
      scene.clear().add(wall).add(field);
      renderer.setPixelRatio(1);
      renderer.setSize(200, 200, false);
      renderer.render(scene, camera);
      const gl = renderer.getContext(),
        out = new Uint8Array(4);
      gl.readPixels(100, 100, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, out);
      return [...out.slice(0, 3)].join();
    };
    const pixels = [pixel(-2 * radius), pixel(2 * radius)];
    const ray = new THREE.Raycaster(camera.position, new THREE.Vector3(0, 1, 0));
    return { pixels, met: ray.intersectObject(field).map(({ point, normal }) => [point.y / radius, normal.y]) };
  });
  assert.equal(pixels[0], '255,0,255');
  assert.notEqual(pixels[1], '255,0,255');
  assert.equal(met.length, 1);
  assert.ok(met[0][0] < 0 && met[0][0] > -1, `${met}`);
  assert.ok(met[0][1] < 0, 'its normal looks back');
  await page.close();
});

const lacksMarkup = !existsSync(join(web, 'made/viewer_markup.js')) && 'skipped: there is no made/ (web/build.sh)';

test('the element shows splats', { skip: skip || lacksMarkup }, async (t) => {
  writeFileSync(
    join(splats.dir, 'element.html'),
    `<!doctype html><html lang="en"><meta charset="utf-8"><title>Splats</title>
<slf-viewer id="a" src="splats.slf" background="808080" style="width: 320px; height: 320px"></slf-viewer>
<script type="module" src="/some/path/web/viewer/slf_viewer.js"></script>`,
  );
  const page = await newPage(chrome);
  await page.goto(`${server.url}/files/element.html`);
  await page.waitForFunction(() => /^(ready|failed)/.test(document.getElementById('a').state));
  assert.equal(await page.evaluate(() => document.getElementById('a').state), 'ready');
  const base64 = await page.evaluate(async (view) => {
    const { viewer } = document.getElementById('a'),
      { fittingPose } = await import('/some/path/web/viewer/view.js');
    viewer.controls.pose = viewer.stage.pose = fittingPose(viewer.stage.field, view);
    const blob = await viewer.stage.screenshot();
    return btoa(Array.from(new Uint8Array(await blob.arrayBuffer()), (b) => String.fromCharCode(b)).join(''));
  }, splats.views[0]);
  assertLike(t, 'the element', readPng(Buffer.from(base64, 'base64')), splats.pictures[0]);
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('after a lost context the picture is that of before', { skip }, async () => {
  const page = await opened(),
    { data } = await pictureOf(page, splats.views[1], splats.size);
  await loseContext(page);
  await page.waitForFunction(() => document.getElementById('status').textContent === 'The graphics context is back.');
  assert.deepEqual((await pictureOf(page, splats.views[1], splats.size)).data, data);
  await page.close();
});

test('coarse splats show while the file arrives; then surfaces and splats take turns on one canvas', { skip }, async (t) => {
  const page = await newPage(chrome);
  await page.goto(`${server.page}?src=/files/slow.slf&background=808080&embed`);
  await page.waitForFunction(() => document.body.dataset.state === 'coarse');
  const coarse = await page.evaluate(() => ({ points: window.viewer.stage.field.points, splats: window.viewer.stage.field.splats }));
  assert.ok(coarse.splats && coarse.points > 0);
  assert.equal(await settled(page), 'ready');
  assertLike(t, 'whole', await pictureOf(page, splats.views[2], splats.size), splats.pictures[2]);
  for (const [name, isSplats] of [['can', false], ['splats', true]]) {
    await page.evaluate((url) => window.viewer.open(url, 'x'), `/files/${name}.slf`);
    assert.equal(Boolean(await page.evaluate(() => window.viewer.stage.field.splats)), isSplats);
    const expected = rendered(join(splats.dir, `${name}.slf`), splats.views[3], splats.size);
    assertLike(t, name, await pictureOf(page, splats.views[3], splats.size), expected);
  }
  assert.deepEqual(page.wrong, []);
  await page.close();
});

test('more splats than a device holds are refused in words', { skip }, async () => {
  const page = await opened();
  const kind = await page.evaluate(() => {
    const { stage } = window.viewer;
    try {
      stage.setField({ ...stage.packed, rows: 1 << 20 });
      return 'taken';
    } catch (error) {
      return error.kind;
    }
  });
  assert.equal(kind, 'too-large');
  await page.close();
});

test('slf html makes a page of splats, from a disk, with the picture of slf render', { skip }, async (t) => {
  const file = join(splats.dir, 'page.html'),
    { azimuth, elevation } = splats.views[1];
  try {
    slf('html', splats.file, '-o', file, '--azimuth', azimuth, '--elevation', elevation, '--background', '808080', '--quiet');
  } catch (error) {
    if (error.status !== 6) throw error;
    return t.skip('skipped: slf was built before web/dist/one_file.html; npm run build, then build slf');
  }
  const page = await newPage(chrome, { viewport: { width: splats.size, height: splats.size } });
  await page.goto(pathToFileURL(file).href, { waitUntil: 'domcontentloaded' });
  assert.equal(await settled(page), 'ready');
  assertLike(t, 'the page', await pictureOf(page, null, splats.size), splats.pictures[1]);
  const beside = statSync(file).size - Math.ceil(splats.bytes.length / 3) * 4;
  t.diagnostic(`${beside} bytes beside the file of ${splats.bytes.length}`);
  assert.ok(beside <= MOST_BESIDE_FILE, `${beside} bytes`);
  assert.deepEqual(page.wrong, []);
  await page.close();
});
