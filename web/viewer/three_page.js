// SPDX-License-Identifier: Apache-2.0
// The loader in a scene of its own: a light field on a plinth, among meshes that hide it and that it
// hides. What moves plays, unless less motion is asked for. three.html?src=FILE
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { SLFLoader } from './SLFLoader.js';
import { upAxes } from './view.js';

const renderer = new THREE.WebGLRenderer({ antialias: true });
document.body.prepend(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color('#e9e5dd');
const camera = new THREE.PerspectiveCamera(30, 1, 0.01, 100);
const controls = new OrbitControls(camera, renderer.domElement);
scene.add(new THREE.HemisphereLight('#ffffff', '#b8ac98', 3));

const query = new URLSearchParams(location.search);
const draw = () => renderer.render(scene, camera);
controls.addEventListener('change', draw);

function resize() {
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  renderer.setSize(innerWidth, innerHeight, false);
  camera.aspect = innerWidth / innerHeight;
  camera.updateProjectionMatrix();
  draw();
}

/** Upright, two units high, on y = 0. */
function stand(field) {
  const { centre, size, up } = field.packed,
    [first, second, third] = upAxes(up);
  const scale = 2 / Math.abs(third.reduce((sum, v, k) => sum + v * size[k], 0));
  const turn = new THREE.Matrix4()
    .makeBasis(...[first, third, second.map((v) => -v)].map((v) => new THREE.Vector3(...v)))
    .invert();
  field.scale.setScalar(scale);
  field.quaternion.setFromRotationMatrix(turn);
  field.position
    .set(...centre)
    .multiplyScalar(-scale)
    .applyQuaternion(field.quaternion);
  field.position.y += 1;
}

function plinth() {
  const material = new THREE.MeshStandardMaterial({ color: '#cfc6b6', roughness: 0.9 });
  const top = new THREE.Mesh(new THREE.CylinderGeometry(0.9, 0.95, 0.12, 96), material);
  top.position.y = -0.02;
  const ring = new THREE.Mesh(
    new THREE.TorusGeometry(0.85, 0.02, 16, 128),
    new THREE.MeshStandardMaterial({ color: '#8a3b12', roughness: 0.5 }),
  );
  ring.rotation.x = Math.PI / 2;
  ring.position.y = 1;
  return [top, ring];
}

/** The page's clock moves it; every frame that shows is drawn, by whatever it was asked for. */
function playIn(field) {
  let last = null;
  field.addEventListener('framechange', draw);
  renderer.setAnimationLoop((now) => {
    field.update((now - (last ?? now)) / 1000);
    last = now;
  });
  if (!matchMedia('(prefers-reduced-motion: reduce)').matches) field.play();
}

try {
  const field = await new SLFLoader().loadAsync(query.get('src') ?? 'can.slf');
  stand(field);
  scene.add(field, ...plinth());
  camera.position.set(3.2, 2.2, 3.8);
  controls.target.set(0, 0.9, 0);
  controls.update();
  document.getElementById('note').textContent =
    `${field.packed.points.toLocaleString('en')} points in a three.js scene`;
  addEventListener('resize', resize);
  resize();
  if (field.frames) playIn(field);
  Object.assign(window, { scene, camera, renderer, field, THREE, ready: true });
} catch (error) {
  document.getElementById('note').textContent = error.message;
  window.failed = error;
}
