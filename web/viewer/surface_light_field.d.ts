// Types of surface_light_field.js.
import type { BufferGeometry, Mesh, MeshBasicMaterial } from 'three';
import type { SlfInfo } from '../slf.js';
import type { PackedField } from './packed_field.js';

/**
 * A light field in a scene, drawn with WebGLRenderer. Moves, turns and scales (evenly) like any object;
 * materials, fog and tone mapping do not apply. Call dispose() when it is taken out.
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

  /** Frees the textures of every renderer. */
  dispose(): void;
}
