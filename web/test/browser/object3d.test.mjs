// SPDX-License-Identifier: Apache-2.0
// A light field as an object of three.js: bounds, rays, clones, layers, what is before and behind it.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { newPage, skip } from './support.mjs';
import { viewerUnderTest } from './viewer_support.mjs';

const here = viewerUnderTest();

/** three.html with its light field alone in the scene, moved, turned and scaled. */
async function scenePage() {
  const page = await newPage(here.chrome, { viewport: { width: 400, height: 400 } });
  await page.goto(`${here.server.three}?src=/files/can.slf`);
  await page.waitForFunction(() => window.ready);
  await page.evaluate(() => {
    const { THREE, scene, camera, renderer, field } = window;
    scene.clear();
    scene.add(field);
    scene.background = null;
    scene.updateMatrixWorld(true);
    const size = 200, target = new THREE.WebGLRenderTarget(size, size, { type: THREE.UnsignedByteType, colorSpace: THREE.SRGBColorSpace });
    camera.aspect = 1;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    /** RGBA of what is drawn at a place of the picture, -1 .. 1. */
    window.drawn = () => {
      renderer.setRenderTarget(target);
      renderer.setClearColor(0, 0);
      renderer.clear();
      renderer.render(scene, camera);
      const data = new Uint8Array(4 * size * size);
      renderer.readRenderTargetPixels(target, 0, 0, size, size, data);
      renderer.setRenderTarget(null);
      return (x, y) => Array.from(data.subarray(4 * (Math.floor((y + 1) / 2 * size) * size + Math.floor((x + 1) / 2 * size))).subarray(0, 4));
    };
    window.along = (x, y, more = (ray) => ray) => {
      const ray = more(new THREE.Raycaster());
      ray.setFromCamera(new THREE.Vector2(x, y), camera);
      return ray.intersectObjects(scene.children);
    };
  });
  return page;
}

test('its bounds are those of its discs, as they stand in the scene', { skip }, async () => {
  const page = await scenePage();
  const { box, exact, centre, packed, outside } = await page.evaluate(async () => {
    const { placeOf } = await import(new URL('packed_texels.js', document.baseURI));
    const { THREE, field } = window, box = new THREE.Box3().setFromObject(field), { packed } = field;
    let outside = 0;
    for (let p = 0; p < packed.points; ++p) {
      const at = new THREE.Vector3(...placeOf(packed, p).map((v, k) => packed.centre[k] + packed.step * (v - packed.middle[k])));
      outside += !box.clone().expandByScalar(packed.step).containsPoint(at.applyMatrix4(field.matrixWorld));
    }
    const list = (b) => [...b.min.toArray(), ...b.max.toArray()];
    return { box: list(box), exact: list(new THREE.Box3().setFromObject(field, true)), outside,
      centre: new THREE.Vector3(...packed.centre).applyMatrix4(field.matrixWorld).toArray(),
      packed: { size: packed.size.map((v) => v * field.scale.x) } };
  });
  assert.equal(outside, 0);
  box.forEach((v, i) => assert.ok(Math.abs(v - exact[i]) < 1e-5));
  for (let k = 0; k < 3; ++k) assert.ok(Math.abs((box[k] + box[3 + k]) / 2 - centre[k]) < 0.1);
  assert.ok(Math.abs(box[4] - box[1] - 2) < 0.15, 'two units high, as the page stands it');
  assert.ok(packed.size.every((v) => v > 0.1));
  await page.close();
});

test('a ray gives the point, its normal, and the colour that is drawn there', { skip }, async (t) => {
  const page = await scenePage();
  const found = await page.evaluate(() => {
    const { THREE, camera, field } = window, pixel = window.drawn(), rows = [];
    for (let y = -0.8; y <= 0.8; y += 0.1)
      for (let x = -0.8; x <= 0.8; x += 0.1) {
        const [met] = window.along(x, y), rgba = pixel(x, y);
        if (!met) {
          rows.push({ alpha: rgba[3] });
          continue;
        }
        const back = met.normal.clone().transformDirection(field.matrixWorld).dot(camera.position.clone().sub(met.point));
        const seen = met.point.clone().project(camera);
        const colour = met.color.clone().convertLinearToSRGB().toArray().map((v) => 255 * v);
        rows.push({ alpha: rgba[3], hit: met.object === field, back, off: Math.hypot(seen.x - x, seen.y - y),
          far: Math.abs(met.distance - camera.position.distanceTo(met.point)),
          apart: Math.max(...colour.map((v, k) => Math.abs(v - rgba[k]))) });
      }
    return rows;
  });
  const hits = found.filter((row) => row.hit), inner = hits.filter((row) => row.alpha === 255);
  assert.ok(hits.length > 40, `${hits.length} rays of ${found.length} meet it`);
  assert.ok(found.filter((row) => !row.hit && row.alpha === 255).length === 0, 'what is drawn is met');
  for (const row of hits) assert.ok(row.back > 0 && row.off < 1e-3 && row.far < 1e-3, JSON.stringify(row));
  const apart = inner.map((row) => row.apart).sort((a, b) => a - b), median = apart[apart.length >> 1];
  t.diagnostic(`grey levels between ray and pixel: median ${median.toFixed(1)}, most ${apart.at(-1).toFixed(1)}, ${inner.length} rays`);
  assert.ok(median < 8, `${median}`); // a pixel is a mean over several discs
  await page.close();
});

test('far, near and layers of a ray, and layers of a camera, are honoured', { skip }, async () => {
  const page = await scenePage();
  const said = await page.evaluate(() => {
    const { field, camera } = window, [{ distance }] = window.along(0, 0);
    const hits = (change) => window.along(0, 0, (ray) => (change(ray), ray)).length;
    const before = window.drawn()(0, 0)[3];
    const counts = [hits((ray) => (ray.far = distance / 2)), hits((ray) => (ray.near = 2 * distance)), hits(() => {})];
    field.layers.set(3);
    counts.push(hits(() => {}), hits((ray) => ray.layers.enable(3)));
    const hidden = window.drawn()(0, 0)[3];
    camera.layers.enable(3);
    const shown = window.drawn()(0, 0)[3];
    field.visible = false;
    return { counts, alphas: [before, hidden, shown, window.drawn()(0, 0)[3]] };
  });
  assert.deepEqual(said.counts, [0, 0, 1, 0, 1]);
  assert.deepEqual(said.alphas, [255, 0, 255, 0]);
  await page.close();
});

test('a clone has the picture of its original and its textures, which go with the last of both', { skip }, async () => {
  const page = await scenePage();
  const said = await page.evaluate(() => {
    const { THREE, scene, field } = window, { createTexture, deleteTexture } = WebGL2RenderingContext.prototype;
    let textures = 0;
    WebGL2RenderingContext.prototype.createTexture = function () {
      ++textures;
      return createTexture.call(this);
    };
    WebGL2RenderingContext.prototype.deleteTexture = function (x) {
      if (x) --textures;
      return deleteTexture.call(this, x);
    };
    field.exposure = 0.5;
    field.add(new THREE.Group());
    const one = window.drawn()(0.05, 0.05), clone = field.clone();
    scene.remove(field);
    scene.add(clone);
    scene.updateMatrixWorld(true);
    const start = textures, other = window.drawn()(0.05, 0.05), made = textures - start;
    const same = [clone.exposure, clone.children.length, clone.position.equals(field.position)];
    field.dispose();
    field.dispose();
    const still = window.drawn()(0.05, 0.05), kept = textures;
    clone.dispose();
    return { one, other, still, made, same, freed: kept - textures };
  });
  assert.deepEqual(said.other, said.one);
  assert.deepEqual(said.still, said.one);
  assert.equal(said.made, 0);
  assert.deepEqual(said.same, [0.5, 1, true]);
  assert.ok(said.freed >= 9, `${said.freed}`);
  await page.close();
});

test('a mesh before it hides it, one behind is hidden, one through it is cut where the surface is', { skip }, async () => {
  const page = await scenePage();
  const said = await page.evaluate(() => {
    const { THREE, scene, camera } = window, [met] = window.along(0, 0);
    const wall = new THREE.Mesh(new THREE.PlaneGeometry(9, 9), new THREE.MeshBasicMaterial({ color: 0x00ff00, side: THREE.DoubleSide }));
    scene.add(wall);
    const green = (distance) => {
      const ray = new THREE.Raycaster();
      ray.setFromCamera(new THREE.Vector2(0, 0), camera);
      wall.position.copy(ray.ray.at(distance, new THREE.Vector3()));
      wall.lookAt(camera.position);
      scene.updateMatrixWorld(true);
      const [r, g, b] = window.drawn()(0.003, 0.003);
      return r < 10 && g > 245 && b < 10;
    };
    return [0.5, 0.97, 1.03, 1.5].map((factor) => green(met.distance * factor));
  });
  assert.deepEqual(said, [true, true, false, false]);
  await page.close();
});
