// SPDX-License-Identifier: Apache-2.0
// Compiled and not run: what the documentation shows, and what must not compile.
import { Box3, PerspectiveCamera, Raycaster, Scene, WebGLRenderer } from 'three';
import { SlfDecoder, SlfError, SlfStream } from 'slf-decoder';
import { SlfFrameStream, frames } from 'slf-decoder/frames';
import { SlfWorker, type SlfInfo } from 'slf-decoder/worker';
import { SLFLoader } from 'slf-decoder/viewer/SLFLoader.js';
import { SurfaceLightField, type LightFieldIntersection } from 'slf-decoder/viewer/surface_light_field.js';
import { Viewer } from 'slf-decoder/viewer/viewer.js';
import { SlfViewerElement } from 'slf-decoder/viewer/slf_viewer.js';
import { ViewerError, packField } from 'slf-decoder/viewer/packed_field.js';

export async function scene(file: File, bytes: ArrayBuffer) {
  const loader = new SLFLoader().setPart({ levels: 7, layers: 1 });
  loader.maxMemory = 1e9;
  const field: SurfaceLightField = await loader.loadAsync('can.slf', (event) => event.loaded);
  const whole = await loader.stream('can.slf', (coarse) => coarse.dispose());
  const others = [await loader.loadAsync(file), await loader.parse(bytes), await loader.parse(new Uint8Array(bytes))];
  loader.load('can.slf', (loaded) => (loaded.exposure = 1), undefined, (error) => error instanceof ViewerError && error.kind);
  const all = new Scene().add(field, whole, ...others);
  new WebGLRenderer().render(all, new PerspectiveCamera());
  // @ts-expect-error a light field has no colour
  field.colour = 'red';
  // @ts-expect-error levels are a number
  loader.setPart({ levels: '7' });
  return field.info.points;
}

export async function decoded(bytes: Uint8Array) {
  const decoder = await SlfDecoder.create();
  try {
    const field = decoder.decode(bytes, { levels: 8, layers: 1 });
    const packed = packField(field, 33);
    field.release();
    return packed.radius;
  } catch (error) {
    return error instanceof SlfError ? error.code : undefined;
  }
}

export async function read(url: string, bytes: Uint8Array) {
  const stream = await SlfStream.open(url), worker = await SlfWorker.create();
  const field = await worker.decode(bytes, { levels: 8 }, { arrays: ['positions', 'weights'] });
  const info: SlfInfo = field.info;
  return [info.points, field.weights?.length, stream.preflight().requests];
}

export async function played(url: string, canvas: { show(points: Float32Array): void }) {
  const times: number[] = [];
  for await (const frame of frames(url, { levels: 8, keepBytes: 1e8 })) {
    if (frame.error) continue;
    canvas.show(frame.field.weights());
    times.push(frame.time);
    // @ts-expect-error a frame's time is read alone, and a number
    frame.time.slice();
  }
  const stream = await SlfFrameStream.open(new Blob());
  return [times, stream.list.length, (await stream.decode(0)).points];
}

export async function viewer() {
  const page = new Viewer({ background: 'grey', levels: 5 });
  await page.open('can.slf');
  // @ts-expect-error numbers are no source
  await page.open(7);
  return page.facts.loaded;
}

export async function element(bytes: Uint8Array) {
  SlfViewerElement.parts = { wasm: '/slf.wasm', locateFile: (name) => `/parts/${name}` };
  const viewer = document.createElement('slf-viewer');
  viewer.addEventListener('ready', ({ detail }) => detail.points.toFixed());
  viewer.addEventListener('error', ({ detail }) => detail.kind === 'policy');
  viewer.view = { azimuth: 40, zoom: '2' };
  await viewer.open(bytes, 'own.slf');
  // @ts-expect-error a state is read alone
  viewer.state = 'ready';
  return [viewer.view?.target, await viewer.picture()];
}

export async function moving(field: SurfaceLightField) {
  field.addEventListener('framechange', ({ frame, time, target }) => [frame.toFixed(), time, target.visible]);
  field.addEventListener('frameerror', ({ error }) => error.kind);
  field.addEventListener('ended', () => field.setTime(0));
  Object.assign(field, { loop: false, speed: 2 });
  field.play();
  const goesOn: boolean = field.update(1 / 60);
  // @ts-expect-error a place is read alone: setFrame()
  field.frame = 3;
  return [goesOn, field.paused, field.time / field.duration, (await field.setTime(1.5)) < field.frames, await field.setFrame(0)];
}

export function met(field: SurfaceLightField) {
  const loader = new SLFLoader(undefined, { wasm: new URL('slf.wasm', 'http://localhost'), worker: () => new Worker('w.js') });
  const [found] = new Raycaster().intersectObject(field) as LightFieldIntersection[];
  return [loader.wasm, new Box3().setFromObject(field.clone()), found.color.getHex(), found.normal.x, found.index];
}
