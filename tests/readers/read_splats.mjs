// SPDX-License-Identifier: Apache-2.0
// Files of `slf export` as three.js reads them: positions, discs, and colours evaluated from the
// coefficients that its loaders give, by the formulas of KHR_gaussian_splatting, against what the
// light field shows. Exits with 77 (skipped) where three is not installed, neither here nor, of the same
// version, in web/:
//   npm ci --prefix tests/readers
//   node tests/readers/read_splats.mjs DIRECTORY        DIRECTORY: written by tests/splat_files
import { existsSync, readFileSync } from 'node:fs'
import { createRequire } from 'node:module'
import { join } from 'node:path'
import { pathToFileURL } from 'node:url'

/** The folder whose packages have the version of three that package.json asks for. */
function folderWithThree() {
  const wanted = createRequire(import.meta.url)('./package.json').devDependencies.three
  return ['./', '../../web/'].map((folder) => new URL(folder, import.meta.url)).find((folder) => {
    const about = new URL('node_modules/three/package.json', folder)
    return existsSync(about) && JSON.parse(readFileSync(about, 'utf8')).version === wanted
  })
}

const folder = folderWithThree()
if (!folder) {
  console.log('read_splats: skipped, there is no three of the version of package.json (npm ci --prefix tests/readers)')
  process.exit(77)
}
const three = createRequire(folder)
const addon = (name) => import(pathToFileURL(three.resolve(`three/addons/loaders/${name}.js`)).href)
globalThis.self ??= globalThis  // GLTFLoader expects a page or a worker
const loaders = {
  ...await addon('GaussianSplatPLYLoader'),
  ...await addon('SPZLoader'),
  ...await addon('GLTFLoader'),
  ...await addon('GLTFGaussianSplatLoaderExtension'),
}

const directory = process.argv[2]
const expected = JSON.parse(readFileSync(join(directory, 'expected.json'), 'utf8'))
const bytesOf = (name) => {
  const file = readFileSync(join(directory, name))
  return file.buffer.slice(file.byteOffset, file.byteOffset + file.byteLength)
}

const load = {
  'ball.ply': (bytes) => new loaders.GaussianSplatPLYLoader().parse(bytes),
  'ball.spz': (bytes) => new loaders.SPZLoader().parse(bytes),
  'ball.glb': async (bytes) => {
    const loader = new loaders.GLTFLoader()
    loader.register((parser) => new loaders.GLTFGaussianSplatLoaderExtension(parser))
    const { scene } = await loader.parseAsync(bytes, '')
    let geometry
    scene.traverse((object) => { geometry = object.splatGeometry ?? geometry })
    return geometry
  },
}

/** Real harmonics of degrees 1 to 3 along (x, y, z), appendix A of KHR_gaussian_splatting. */
function harmonics([x, y, z]) {
  return [
    -0.4886025119 * y, 0.4886025119 * z, -0.4886025119 * x,
    1.0925484306 * x * y, -1.0925484306 * y * z, 0.3153915653 * (2 * z * z - x * x - y * y),
    -1.0925484306 * x * z, 0.5462742153 * (x * x - y * y),
    -0.5900435899 * y * (3 * x * x - y * y), 2.8906114426 * x * y * z,
    -0.4570457995 * y * (4 * z * z - x * x - y * y), 0.3731763326 * z * (2 * z * z - 3 * x * x - 3 * y * y),
    -0.4570457995 * x * (4 * z * z - x * x - y * y), 1.4453057213 * z * (x * x - y * y),
    -0.5900435899 * x * (x * x - 3 * y * y),
  ]
}

/** Coefficient k = 0 .. 14 and channel c of splat i, from three's packed bytes: v / 128 - 1. */
function coefficient(geometry, i, k, c) {
  const band = k < 3 ? 1 : k < 8 ? 2 : 3
  const attribute = geometry.getAttribute(`sphericalHarmonics${band}`)
  const bytes = new Uint8Array(attribute.array.buffer, attribute.array.byteOffset)
  return bytes[i * attribute.itemSize * 4 + (k - [0, 0, 3, 8][band]) * 3 + c] / 128 - 1
}

function colour(geometry, i, towardsEye) {
  const row = harmonics(towardsEye.map((v) => -v))  // from the eye to the splat
  const base = geometry.getAttribute('color')
  return [0, 1, 2].map((c) => {
    let sum = base.array[4 * i + c]
    row.forEach((y, k) => { sum += 255 * y * coefficient(geometry, i, k, c) })
    return Math.min(255, Math.max(0, sum))
  })
}

let failures = 0
function check(condition, text) {
  if (condition) return
  failures++
  console.error(`FAILED ${text}`)
}

for (const [name, { count, points }] of Object.entries(expected)) {
  const geometry = await load[name](bytesOf(name))
  const centres = geometry.getAttribute('position')
  const covariance = geometry.getAttribute('covariance')
  check(centres.count === count, `${name}: ${centres.count} splats, not ${count}`)
  let squares = 0, values = 0
  for (const { index, position, normal, deviation, views } of points) {
    position.forEach((x, k) => check(Math.abs(centres.array[3 * index + k] - x) < 1e-4,
      `${name}: splat ${index} is not at ${position}`))
    // Across the disc the variance is that of the deviation, along the normal a hundredth.
    const [xx, xy, xz, yy, yz, zz] = Array.from(covariance.array.slice(6 * index, 6 * index + 6))
    const [a, b, c] = normal
    const along = a * a * xx + b * b * yy + c * c * zz + 2 * (a * b * xy + a * c * xz + b * c * yz)
    const across = (xx + yy + zz - along) / 2
    check(Math.abs(Math.sqrt(across) / deviation - 1) < 0.05, `${name}: splat ${index}: deviation`)
    check(along < 0.02 * across, `${name}: splat ${index} is not flat along its normal`)
    for (const { towards_eye, rgb } of views)
      colour(geometry, index, towards_eye).forEach((v, k) => { squares += (v - rgb[k]) ** 2; values++ })
  }
  const psnr = 10 * Math.log10(255 * 255 * values / squares)
  console.log(`${name}: ${count} splats, colours ${psnr.toFixed(1)} dB`)
  // Coefficients rounded to 1/128 by the reader, and by SPZ to 1/32, are all that is lost.
  check(psnr > (name.endsWith('spz') ? 32 : 40), `${name}: colours ${psnr} dB`)
}
process.exit(failures ? 1 : 0)
