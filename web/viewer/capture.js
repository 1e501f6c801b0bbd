// SPDX-License-Identifier: Apache-2.0
// Cameras and photographs of a capture (docs/captures.md): cameras.json or transforms.json, from a
// folder on a server or from files that were dropped.
import { ViewerError } from './packed_field.js';

/**
 * @typedef {object} CaptureCamera  OpenCV axes, first row of the picture on top
 * @property {string} name  of the image
 * @property {number} width, height, fx, fy, cx, cy
 * @property {number[]} rotation  [9] world to camera
 * @property {number[]} eye  [3] world
 * @property {boolean} distorted  its lens bends lines: the picture of a rendering lies beside it, not on it
 * @property {() => Promise<ImageBitmap>} photograph
 */

/**
 * @param {string|URL} folder  address; the files are looked for in it
 * @returns {Promise<CaptureCamera[]>}
 * @throws {ViewerError} 'network', 'damaged'
 */
export async function fetchCapture(folder) {
  const base = new URL(String(folder).endsWith('/') ? folder : `${folder}/`, location.href);
  for (const [name, read] of Object.entries(READERS)) {
    const response = await fetch(new URL(name, base)).catch(() => null);
    if (!response?.ok) continue;
    const image = async (path) => {
      const found = await fetch(inside(base, path));
      return found.ok ? found.blob() : null;
    };
    return camerasOf(await response.json().catch(() => null), read, name, image);
  }
  throw new ViewerError('network', 'No camera can be used.', `${folder}: no cameras.json, no transforms.json`);
}

/** The same of files that were dropped together; null where none of them lists cameras. */
export async function droppedCapture(files) {
  for (const [name, read] of Object.entries(READERS)) {
    const list = files.find((file) => file.name === name);
    if (!list) continue;
    const image = async (path) => {
      const last = path.split('/').pop();
      return files.find((each) => each.name === last || each.name.replace(/\.[^.]+$/, '') === last);
    };
    const root = await new Response(list).json().catch(() => null);
    return camerasOf(root, read, name, image);
  }
  return null;
}

const READERS = { 'cameras.json': readCameras, 'transforms.json': readTransforms };

function camerasOf(root, read, name, image) {
  const cameras = root && typeof root === 'object' ? read(root) : [];
  const usable = cameras.filter(
    (c) =>
      [c.width, c.height, c.fx, c.fy].every((v) => v > 0) &&
      [c.cx, c.cy, ...c.rotation, ...c.eye].every(Number.isFinite) &&
      c.rotation.length === 9,
  );
  if (!usable.length) throw new ViewerError('damaged', 'No camera can be used.', name);
  for (const camera of usable)
    camera.photograph = () =>
      image(camera.name)
        .then(createImageBitmap)
        .catch(() => {
          throw new ViewerError('network', 'The file cannot be fetched.', camera.name);
        });
  return usable;
}

/** An image may not lead out of its capture. */
function inside(base, path) {
  const address = new URL(path, base);
  if (!address.href.startsWith(base.href)) throw new RangeError(path);
  return address;
}

function readCameras({ cameras }) {
  if (!Array.isArray(cameras)) return [];
  return cameras
    .filter((c) => c?.K?.[1] && c.R?.[2] && c.t)
    .map((c) => {
      const rotation = c.R.flat(),
        t = c.t;
      return {
        name: String(c.image ?? ''),
        width: c.width,
        height: c.height,
        fx: c.K[0][0],
        fy: c.K[1][1],
        cx: c.K[0][2],
        cy: c.K[1][2],
        rotation,
        eye: [0, 1, 2].map((k) => -(rotation[k] * t[0] + rotation[3 + k] * t[1] + rotation[6 + k] * t[2])),
      };
    });
}

/** Camera to world, x right, y up, looking along -z: y and z change sign. */
function readTransforms(root) {
  if (!Array.isArray(root.frames)) return [];
  return root.frames
    .filter((f) => f?.transform_matrix?.[2])
    .map((f) => {
      const of = (key) => f[key] ?? root[key],
        m = f.transform_matrix;
      const width = of('w') ?? 0,
        height = of('h') ?? 0;
      const focal = (key, angle, size) => of(key) ?? size / (2 * Math.tan((of(angle) ?? NaN) / 2));
      const fx = focal('fl_x', 'camera_angle_x', width);
      const fy = of('fl_y') ?? (of('camera_angle_y') ? focal('fl_y', 'camera_angle_y', height) : fx);
      return {
        name: withExtension(String(f.file_path ?? '')),
        width,
        height,
        fx,
        fy,
        cx: of('cx') ?? width / 2,
        cy: of('cy') ?? height / 2,
        distorted: ['k1', 'k2', 'p1', 'p2'].some((key) => of(key)),
        rotation: [m[0][0], m[1][0], m[2][0], -m[0][1], -m[1][1], -m[2][1], -m[0][2], -m[1][2], -m[2][2]],
        eye: [m[0][3], m[1][3], m[2][3]],
      };
    });
}

const withExtension = (path) => (/\.\w+$/.test(path.split('/').pop()) ? path : `${path}.png`);

/**
 * PSNR of a rendering against the photograph where the light field covers the pixel.
 * @param {Uint8ClampedArray} photograph  RGBA, rows from the top
 * @param {Uint8Array} rendering  RGBA, rows from the bottom, alpha is coverage
 * @returns {number} dB; NaN where nothing shows
 */
export function psnrWithin(photograph, rendering, width, height) {
  let sum = 0,
    count = 0;
  for (let y = 0; y < height; ++y)
    for (let x = 0; x < width; ++x) {
      const a = 4 * (y * width + x),
        b = 4 * ((height - 1 - y) * width + x);
      if (rendering[b + 3] < 255 || photograph[a + 3] < 255) continue;
      for (let k = 0; k < 3; ++k) sum += (photograph[a + k] - rendering[b + k]) ** 2;
      count += 3;
    }
  return count ? 10 * Math.log10((255 ** 2 * count) / sum) : NaN;
}
