// SPDX-License-Identifier: Apache-2.0
import { PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { SLFLoader } from 'slf-decoder/viewer/SLFLoader.js';

const renderer = new WebGLRenderer(), camera = new PerspectiveCamera(30, 4 / 3, 0.01, 100);
document.body.append(renderer.domElement);
renderer.setSize(400, 300);
const field = await new SLFLoader(undefined, { /* parts */ }).loadAsync('/can.slf');
camera.position.set(...field.packed.centre.map((x, k) => x + [3, 0, 0][k] * field.packed.radius));
camera.up.set(0, 0, 1);
camera.lookAt(...field.packed.centre);
renderer.render(new Scene().add(field), camera);
window.ready = true;
