// SPDX-License-Identifier: Apache-2.0
// Types of surface_light_field.js.
import type { BufferGeometry, Color, Intersection, Mesh, MeshBasicMaterial, Object3DEventMap, Vector3 } from 'three';
import type { SlfInfo } from '../slf.js';
import type { PackedField, ViewerError } from './packed_field.js';

/** What Raycaster finds of a light field. */
export interface LightFieldIntersection extends Intersection<SurfaceLightField> {
  /** The point whose disc is met. */
  index: number;
  /** The surface's, towards the ray's origin, in the object's axes. */
  normal: Vector3;
  /** What is seen along the ray, with the object's exposure. */
  color: Color;
}

/** What a light field that moves tells, of its clones too. */
export interface LightFieldEventMap extends Object3DEventMap {
  /** Another frame shows. frame: its place from 0; number as the file has it; time in seconds. */
  framechange: { frame: number; number: number; time: number };
  /** A frame is damaged. It is passed over. */
  frameerror: { frame: number; number: number; error: ViewerError };
  /** The last frame was shown, and there is no loop. */
  ended: {};
  /** What ends playing: a connection, a lack of memory. */
  error: { error: ViewerError };
}

/**
 * A light field in a scene, drawn with WebGLRenderer. Moves, turns and scales (evenly) like any object; has bounds,
 * layers and rays; materials, lamps, shadows, fog and tone mapping do not apply. Call dispose() when it is taken out.
 */
export class SurfaceLightField extends Mesh<BufferGeometry, MeshBasicMaterial, LightFieldEventMap> {
  constructor(packed: PackedField, info?: Partial<SlfInfo>);

  readonly isSurfaceLightField: true;
  /** What the headers say of the frame that shows. */
  readonly info: Partial<SlfInfo>;
  /** What shows. */
  readonly packed: PackedField;
  /** Without what depends on the view. */
  meanOnly: boolean;
  /** Stops. */
  exposure: number;
  /** Of the points that are drawn, 0 to 1. */
  share: number;

  /** Frames that have arrived; 0 where nothing moves. */
  readonly frames: number;
  /** Place of the frame that shows or is being jumped to, from 0. */
  readonly frame: number;
  /** Seconds of the frames that have arrived; 0 where nothing moves. */
  readonly duration: number;
  /** Seconds from the first frame to `frame`. */
  readonly time: number;
  readonly paused: boolean;
  /** Plays over and over; true. */
  loop: boolean;
  /** 1: as the file has it; 1/16 to 16. */
  speed: number;
  /** From where it stands; from the first frame, where it has ended. update() moves it. */
  play(): void;
  pause(): void;
  /**
   * Moves what plays on, before a scene is rendered; once for all clones.
   * @param seconds  since the last call; what is above a quarter of a second counts as that
   * @returns whether it plays
   * @throws {RangeError} of no such number
   */
  update(seconds: number): boolean;
  /**
   * To the frame of a time: where it repeats, of a time in any lap, else from the first to the last.
   * @returns the place of the frame that was asked for last, when it shows. Rejected with a ViewerError where a decode
   *   fails, with an AbortError after dispose()
   * @throws {RangeError} of no such number
   */
  setTime(seconds: number): Promise<number>;
  /** To a frame that has arrived, by its place from 0; else as setTime(). */
  setFrame(place: number): Promise<number>;

  /** Another of the same textures, which shows the same frame. */
  clone(recursive?: boolean): this;
  /** What is seen of a point from a place in the object's axes. */
  colourOf(index: number, eye: Vector3): Color;
  /** Frees the textures of every renderer and what decodes frames, with the last of its clones. */
  dispose(): void;
}
