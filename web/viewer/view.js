// SPDX-License-Identifier: Apache-2.0
// Cameras: an orbit around a light field as `slf render --orbit` has it, a camera file's entries, and
// what lies between. A View is what point_pipeline.js draws.

/** Right-handed world axes with `up` third, as the C++ renderer's orbit. */
const AXES = {
  '+x': [
    [0, 1, 0],
    [0, 0, 1],
    [1, 0, 0],
  ],
  '-x': [
    [0, 0, 1],
    [0, 1, 0],
    [-1, 0, 0],
  ],
  '+y': [
    [0, 0, 1],
    [1, 0, 0],
    [0, 1, 0],
  ],
  '-y': [
    [1, 0, 0],
    [0, 0, 1],
    [0, -1, 0],
  ],
  '+z': [
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ],
  '-z': [
    [0, 1, 0],
    [1, 0, 0],
    [0, 0, -1],
  ],
};

export const upAxes = (up) => (Object.hasOwn(AXES, up) ? AXES[up] : AXES['+z']);
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const add = (a, b, s = 1) => a.map((x, k) => x + s * b[k]);
export const normalised = (a) => a.map((x) => x / (Math.hypot(...a) || 1));
const mixed = (a, u, b, v, c, w) => u.map((x, k) => a * x + b * v[k] + c * w[k]);

/**
 * Where the camera is and looks.
 * @typedef {object} Pose
 * @property {number[]} target  world; what an orbit turns around
 * @property {number} distance  from the target to the eye
 * @property {number} azimuth, elevation  degrees, of the eye from the target
 * @property {number} fov  degrees, of the shorter side
 */

/** The whole light field in the picture, seen as `slf render --azimuth --elevation --fov` does. */
export function fittingPose(field, { azimuth = 0, elevation = 20, fov = 30 } = {}) {
  const radius = 1.03 * (field.radius + (field.splats ? 0 : field.step));
  return { target: [...field.centre], distance: radius / Math.sin((fov * Math.PI) / 360), azimuth, elevation, fov };
}

/** The pose of a file's own view (`view` of its metadata, spec/registry.md): eye, target, degrees. Null: it has none. */
export function namedPose(field, metadata) {
  const numbers = Object.hasOwn(metadata ?? {}, 'view') ? metadata.view.split(' ').map((word) => (word === '' ? NaN : Number(word))) : [];
  const [eye, target, fov] = [numbers.slice(0, 3), numbers.slice(3, 6), numbers[6]],
    back = add(eye, target, -1),
    distance = Math.sqrt(dot(back, back));
  if (numbers.length !== 7 || !numbers.every(Number.isFinite) || !(distance > 0 && distance < Infinity) || fov < 1 || fov > 170) return null;
  const [first, second, third] = upAxes(field.up);
  return {
    target,
    distance,
    azimuth: (Math.atan2(dot(back, second), dot(back, first)) * 180) / Math.PI,
    elevation: (Math.asin(Math.max(-1, Math.min(1, dot(back, third) / distance))) * 180) / Math.PI,
    fov,
  };
}

/** Rows right, down, forward of a pose. Down is the elevation's derivative: defined at the poles too. */
export function axesOf(pose, up) {
  const [first, second, third] = upAxes(up),
    a = (pose.azimuth * Math.PI) / 180,
    e = (pose.elevation * Math.PI) / 180;
  const ca = Math.cos(a),
    sa = Math.sin(a),
    ce = Math.cos(e),
    se = Math.sin(e);
  return [
    mixed(-sa, first, ca, second, 0, third),
    mixed(se * ca, first, se * sa, second, -ce, third),
    mixed(-ce * ca, first, -ce * sa, second, -se, third),
  ];
}

/** @returns {import('./point_pipeline.js').View} */
export function viewOf(pose, up, width, height) {
  const rows = axesOf(pose, up);
  const focal = Math.min(width, height) / (2 * Math.tan((pose.fov * Math.PI) / 360));
  return {
    width,
    height,
    fx: focal,
    fy: focal,
    cx: width / 2,
    cy: height / 2,
    rotation: rows.flat(),
    eye: add(pose.target, rows[2], -pose.distance),
  };
}

/** Where a place of the world is in the picture of a View; null behind the eye. */
export function pixelOf({ eye, rotation, fx, fy, cx, cy }, place) {
  const from = add(place, eye, -1),
    [x, y, z] = [0, 3, 6].map((row) => dot(rotation.slice(row), from));
  return z > 0 ? [fx * (x / z) + cx, fy * (y / z) + cy] : null;
}

/** Between two poses, the short way round; distances by their ratio. @param share  0: a, 1: b */
export function blendedPose(a, b, share) {
  const mix = (x, y) => x + share * (y - x),
    around = ((b.azimuth - a.azimuth + 540) % 360) - 180;
  return {
    azimuth: a.azimuth + share * (around < -180 ? around + 360 : around),
    elevation: mix(a.elevation, b.elevation),
    fov: mix(a.fov, b.fov),
    distance: a.distance * (b.distance / a.distance) ** share,
    target: a.target.map((x, k) => mix(x, b.target[k])),
  };
}

/**
 * A perspective camera of three or WebXR (x right, y up, looking along -z) as a View in the object's axes.
 * @param p  projection, column-major
 * @param m  camera to object, column-major: a rotation times an even scale, and a place
 * @returns scale: of world lengths over the object's
 */
export function viewOfCamera(p, m, width, height) {
  const length = Math.hypot(m[0], m[1], m[2]),
    axis = (i, sign) => [0, 1, 2].map((k) => (sign * m[4 * i + k]) / length);
  return {
    scale: 1 / length,
    view: {
      width,
      height,
      fx: (p[0] * width) / 2,
      fy: (p[5] * height) / 2,
      cx: (width / 2) * (1 - p[8]),
      cy: (height / 2) * (1 + p[9]),
      rotation: [...axis(0, 1), ...axis(1, -1), ...axis(2, -1)],
      eye: [m[12], m[13], m[14]],
    },
  };
}

/** A camera of a capture in a picture of that size: all of it shows, in the middle. */
export function fittedCamera(camera, width, height) {
  const scale = Math.min(width / camera.width, height / camera.height);
  const left = (width - scale * camera.width) / 2,
    top = (height - scale * camera.height) / 2;
  return {
    width,
    height,
    fx: camera.fx * scale,
    fy: camera.fy * scale,
    cx: camera.cx * scale + left,
    cy: camera.cy * scale + top,
    rotation: camera.rotation,
    eye: camera.eye,
    frame: [left, top, scale * camera.width, scale * camera.height],
  };
}

/** The orbit's pose that looks most like a camera: same eye and line of sight, upright. */
export function poseOfCamera(camera, field) {
  const forward = camera.rotation.slice(6),
    [first, second, third] = upAxes(field.up);
  const along = dot(add(field.centre, camera.eye, -1), forward);
  const distance = along > 0 ? along : field.radius;
  const short = Math.min(camera.width / camera.fx, camera.height / camera.fy);
  return {
    target: add(camera.eye, forward, distance),
    distance,
    azimuth: (Math.atan2(-dot(forward, second), -dot(forward, first)) * 180) / Math.PI,
    elevation: (Math.asin(Math.max(-1, Math.min(1, -dot(forward, third)))) * 180) / Math.PI,
    fov: (2 * Math.atan(short / 2) * 180) / Math.PI,
  };
}
