// SPDX-License-Identifier: Apache-2.0
// Types of surface_light_field.js.
import type { BufferGeometry, Color, Intersection, Mesh, MeshBasicMaterial, Vector3 } from 'three';
import type { SlfInfo } from '../slf.js';
import type { PackedField } from './packed_field.js';

/** What Raycaster finds of a light field. */
export interface LightFieldIntersection extends Intersection<SurfaceLightField> {
  /** The point whose disc is met. */
  index: number;
  /** The surface's, towards the ray's origin, in the object's axes. */
  normal: Vector3;
  /** What is seen along the ray, with the object's exposure. */
  color: Color;
}

/**
 * A light field in a scene, drawn with WebGLRenderer. Moves, turns and scales (evenly) like any object; has bounds,
 * layers and rays; materials, lamps, shadows, fog and tone mapping do not apply. Call dispose() when it is taken out.
 */
export class SurfaceLightField extends Mesh<BufferGeometry, MeshBasicMaterial> {
  constructor(packed: PackedField, info?: Partial<SlfInfo>);

  readonly isSurfaceLightField: true;
  /** What the file's headers say. */
  info: Partial<SlfInfo>;
  packed: PackedField;
  /** Without what depends on the view. */
  meanOnly: boolean;
  /** Stops. */
  exposure: number;
  /** Of the points that are drawn, 0 to 1. */
  share: number;

  /** Another of the same textures. */
  clone(recursive?: boolean): this;
  /** What is seen of a point from a place in the object's axes. */
  colourOf(index: number, eye: Vector3): Color;
  /** Frees the textures of every renderer, with the last of its clones. */
  dispose(): void;
}
