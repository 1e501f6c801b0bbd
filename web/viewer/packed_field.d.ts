// SPDX-License-Identifier: Apache-2.0
// Types of packed_field.js.
import type { SlfField, SlfGrid } from '../slf.js';

/** Why a file is not shown. */
export class ViewerError extends Error {
  constructor(kind: ViewerError['kind'], words: string, detail?: string);
  kind: 'too-large' | 'no-view-maps' | 'no-webgl2' | 'damaged' | 'unsupported' | 'network' | 'memory' | 'policy';
  /** For everybody, and for those who look for the cause; `message` has both. */
  words: string;
  detail: string;
}

/** A decoded light field as texels of the pipeline, and plain numbers; may be posted to a thread. */
export interface PackedField {
  readonly points: number;
  readonly components: number;
  readonly levels: SlfGrid['bits'];
  /** World units from voxel to voxel. */
  readonly step: number;
  /** Of the box that views frame, and of a ball around it, in world units: a few points far away are outside. */
  readonly centre: number[];
  readonly size: number[];
  readonly radius: number;
  /** From the centre to the farthest point of all. */
  readonly reach: number;
  /** Drawn as Gaussian splats (annex E.6). */
  readonly splats?: boolean;
  /** Least and greatest corner of all discs or splats, in world units. */
  readonly box: [number[], number[]];
  readonly up: string;
  readonly linear: boolean;
  readonly partial: boolean;
}

/**
 * @param tableSize  samples along a side of a face of the function table; 65
 * @param arriving  more of the file will come: splats that stand for many are widened
 */
export function packField(field: SlfField, tableSize?: number, arriving?: boolean): PackedField;

/** Of all that can be transferred to another thread without a copy. */
export function buffersOf(packed: PackedField): ArrayBuffer[];
