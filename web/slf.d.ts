// SPDX-License-Identifier: Apache-2.0
// Types of slf.js: surface light fields decoded in WebAssembly, and what the other modules take and give. No globals, no
// dependency; every function throws SlfError.

/**
 * Code of an error: as in include/slf/slf.h without SLF_, and three of the page: network, its own end, its policy.
 * INVALID_ARGUMENT: what the caller gave, whatever the file holds; `element` is the argument's name.
 */
export type SlfCode =
  | 'NOT_SLF' | 'TRUNCATED' | 'CHECKSUM' | 'OUT_OF_RANGE' | 'RESERVED' | 'UNSUPPORTED' | 'LIMIT_EXCEEDED'
  | 'INVALID_ARGUMENT' | 'OUT_OF_MEMORY' | 'CANCELLED' | 'READ_FAILED' | 'INTERNAL' | 'NETWORK' | 'ABORTED'
  | 'POLICY';

export class SlfError extends Error {
  constructor(code: SlfCode, message: string, details?: Partial<Pick<SlfError, 'element' | 'unit' | 'bitOffset'>> & { cause?: unknown });
  readonly code: SlfCode;
  /** Syntax element of the specification at which a stream is wrong, or the argument; may be empty. */
  readonly element: string;
  /** The unit whose element that is: "sequence", "geometry", ...; may be empty. */
  readonly unit: string;
  /** From the first byte of the stream. */
  readonly bitOffset: number;
}

export interface SlfGrid {
  /** World position of voxel (0, 0, 0). */
  origin: [number, number, number];
  /** World units from voxel to voxel: world = origin + step * voxel. */
  step: number;
  /** 1 .. 21 per axis. */
  bits: number;
}

/** What a file holds, from its headers alone. */
export interface SlfInfo {
  version: string;
  profile: 'main' | 'draco' | 'texture';
  bytes: number;
  points: number;
  /** K; 0: geometry alone. */
  functions: number;
  /** R, the coded ones. */
  components: number;
  bits: number;
  /** Of the octree: what options.levels counts; = bits. */
  levels: number;
  slices: number;
  /** What options.groups counts. */
  groups: number;
  /** Of quality, of the group that has most: what options.layers counts; 1 .. 4. */
  layers: number;
  /** Of coded normals; 0: none. */
  normalBits: number;
  grid: SlfGrid;
  /** 0: not known. */
  metresPerUnit: number;
  up: '+x' | '-x' | '+y' | '-y' | '+z' | '-z' | 'unknown';
  rightHanded: boolean;
  /** false: planes without a meaning; no weights, no colours. */
  hasBasis: boolean;
  basis: 'bspline' | 'harmonics';
  directions: 'world' | 'reflected';
  transfer: 'display' | 'linear';
  gamma: [number, number];
  /** false: the file was cut short. */
  complete: boolean;
  /** Parts can be read without the rest. */
  hasIndex: boolean;
  /** Points are Gaussian splats (spec 6.8), and drawn as those (annex E.6). */
  hasSplats: boolean;
  metadata: Record<string, string>;
  /** Memory a decode of all of it takes, estimated from above; whether it is allowed does not matter. Of SlfDecoder.info. */
  decodeBytes?: number;
}

export interface SlfOptions {
  /** Octree levels to keep, 1 .. info.levels; 0: all. Fewer give a coarser grid. */
  levels?: number;
  /** Groups of planes to decode, 1 .. info.groups; 0: all. */
  groups?: number;
  /** Quality layers to decode, 1 .. those of the group that has most; 0: all. */
  layers?: number;
  /** Only units that end within the first maxBytes; 0: all. */
  maxBytes?: number;
  /** Only points whose voxel of the kept levels meets the box: voxels of the whole grid, both corners included, low <= high. */
  region?: { low: ArrayLike<number>; high: ArrayLike<number> };
  /** Refused beyond: LIMIT_EXCEEDED, before anything that large is allocated. 0: the decoder's own limit; Infinity: none. */
  maxPoints?: number;
  /** The same of the memory that preflight() estimates, bytes. */
  maxMemory?: number;
  /** The same of decisions and values to decode. */
  maxWork?: number;
  /** Called between units with the share of bytes decoded; false ends the decode with CANCELLED. */
  onProgress?: (fraction: number) => boolean | void;
}

export interface SlfEstimate {
  components: number;
  /** At most. */
  points: number;
  /** Bytes that would be read of the file and are not here. */
  readBytes: number;
  fieldBytes: number;
  memoryBytes: number;
  /** Of SlfStream: in how many requests. */
  requests?: number;
}

/** The functions on the faces of a cube, GL's order (+x -x +y -y +z -z) and axes. */
export interface SlfFunctionTable {
  /** Texels along an edge; texel i stands at -1 + 2 i / (side - 1), the outermost on the edges. */
  side: number;
  size: number;
  /** ceil(W / 4). */
  layers: number;
  /** W */
  functions: number;
  /** [layers][6][side][side][4]; the last layer is filled up with zeros. */
  data: Float32Array;
}

/** Constants of the reference reconstruction, spec annex E. */
export interface SlfKernel {
  version: number; filterPixels: number; exponent: number; spacingReach: number; leastReach: number; mostReach: number;
  smallest: number; core: number; band: number; steepest: number; flattest: number; discShare: number;
  densityGain: number; densityOffset: number;
}

/** A decoded light field. Its memory is WebAssembly's until release(); arrays handed out are copies that stay. */
export class SlfField {
  private constructor();
  readonly info: SlfInfo;
  /** P */
  readonly points: number;
  /** R */
  readonly components: number;
  /** W: real weights of a point; R, or K with a joint transform; 0 without a basis. */
  readonly functions: number;
  /** Less than the file was made of. */
  readonly partial: boolean;
  /** Of these points: coarser than the file's where levels were left out. */
  readonly grid: SlfGrid;
  readonly directions: 'world' | 'reflected';
  readonly transfer: 'display' | 'linear';
  readonly up: SlfInfo['up'];
  readonly rightHanded: boolean;
  readonly hasBasis: boolean;
  readonly hasNormals: boolean;
  /** Drawn by covariances and opacities, not by discs. */
  readonly hasSplats: boolean;
  /** Directions are clamped to these gammas (sines of elevation). */
  readonly gamma: [number, number];
  readonly kernel: SlfKernel;

  /** [P][3] voxels, Morton order. */
  readonly positions: Uint32Array;
  /** [P][R][3] the integers of the bit exact decode; in 16 bits where all fit. */
  readonly values: Int16Array | Int32Array;
  /** [P][2] coded normals as levels of the octahedral map, or null. */
  readonly octahedral: Uint16Array | null;
  /** Discs that a renderer draws (annex E.2): [P][3] unit normals of either sign; 0: faces the eye. */
  readonly normals: Float32Array;
  /** [P][3] their centres, in voxels: world = grid.origin + grid.step * centre. */
  readonly centres: Float32Array;
  /** [P] their radii, world units. */
  readonly radii: Float32Array;
  /** [P] area of the surface that a point stands for, world units squared. */
  readonly areas: Float32Array;
  /** [P][3] unit normals that directions are mirrored at; null for directions of the world. */
  readonly mirrorNormals: Float32Array | null;
  /** Of splats, else null: [P][6] covariance xx, xy, xz, yy, yz, zz about the point, world units squared. */
  readonly covariances: Float32Array | null;
  /** Of splats, else null: [P] share of what is behind it that a splat hides at its centre, 0 .. 1. */
  readonly opacities: Float32Array | null;

  /** [P][W][3]: radiance = sum over W of weight times function, clamped to 0 .. 255. Of `count` points from `first` on; all. */
  weights(out?: Float32Array, first?: number, count?: number): Float32Array;
  /** [P][3] R, G, B averaged over all directions. */
  meanColours(): Uint8Array;
  /** side: 2 .. 1024 [65]. Linear interpolation is off by what docs/decisions/028 lists. */
  functionTable(options?: { side?: number }): SlfFunctionTable;
  /** [n][3] reference colours of points (whole numbers below P) along world directions from the point to the eye. */
  radiance(points: ArrayLike<number>, directions: ArrayLike<number>): Float32Array;
  /** Frees its memory. The field cannot be read after. */
  release(): void;
}

/** An ArrayBuffer, a SharedArrayBuffer, or a view of one. */
export type SlfBytes = ArrayBufferLike | ArrayBufferView;
/** Where a decoder comes from: an address, a response, bytes or a compiled module, or a promise of one of them. */
export type WasmSource = WasmValue | Promise<WasmValue> | undefined;
type WasmValue = string | URL | Response | ArrayBuffer | ArrayBufferView | WebAssembly.Module;

export interface SlfParts {
  wasm?: WasmSource;
  /** Address of `slf.wasm` or `slf_scalar.wasm`; nothing: beside this module. Not asked where there is `wasm`. */
  locateFile?: (name: string) => string | URL | undefined;
}

export class SlfDecoder {
  private constructor();
  /**
   * NETWORK where it cannot be loaded, POLICY where the page forbids WebAssembly.
   * wasm: default slf.wasm beside this module, or slf_scalar.wasm where there are no 128-bit vectors.
   */
  static create(options?: SlfParts): Promise<SlfDecoder>;
  /** May be posted to workers. */
  readonly module: WebAssembly.Module;
  info(bytes: SlfBytes): SlfInfo;
  preflight(bytes: SlfBytes, options?: SlfOptions): SlfEstimate;
  decode(bytes: SlfBytes, options?: SlfOptions): SlfField;
  /** Frames of a light field that moves, whose bytes are pushed as they come. Options are those of every frame; maxBytes has to be 0. */
  frames(options?: SlfOptions): SlfFrames;
  /** Lets go of memory that is kept for the next decode: it would be after five seconds. */
  trim(): void;
}

/** A frame of a stream (spec 7.13). */
export interface SlfFrame {
  /** From 0, in the list of frames that have arrived. */
  place: number;
  /** As the file has it, ascending. */
  number: number;
  /** Seconds, ascending. */
  time: number;
  /** From the frame before it. */
  predicted: boolean;
  /** No frame could be read here, decode() says why. It stands for one or several. */
  lost: boolean;
  /** Of its first byte in the stream. */
  offset: number;
  bytes: number;
}

/**
 * A reader of what arrives: frames, or a light field that does not move. Its memory is WebAssembly's until release(). Damage
 * costs a group: the next frame that is not predicted is sound.
 */
export class SlfFrames {
  private constructor();
  /** Those that have arrived whole; they stay when their bytes are dropped. */
  readonly list: readonly SlfFrame[];
  /**
   * A light field that does not move whose headers have arrived, and not its end: info(0) and decode(0) give what its units
   * allow, each time from the beginning; `bytes` are theirs. null: there is none, or it is in the list.
   */
  readonly arriving: SlfFrame | null;
  /** Memory that bytes of the stream take. */
  readonly heldBytes: number;
  /** finish() was called. */
  readonly ended: boolean;
  /** Its memory failed, or it was released. */
  readonly dead: boolean;
  /** Levels, groups, layers, region, limits of frames that are decoded from here on. */
  setOptions(options?: SlfOptions): void;
  /**
   * Copies the bytes that follow those of the call before. NOT_SLF and errors of the first frame's headers, and of units of a
   * light field that does not move, are for good.
   */
  push(bytes: SlfBytes): void;
  /** No bytes follow: a frame that was cut short is listed, and the one of a light field that does not move. */
  finish(): void;
  /** Whether the bytes of a frame are here; false where it has not arrived. */
  holds(place: number): boolean;
  /** The frame that the group of this one begins with, of one that has arrived. */
  groupOf(place: number): number;
  /** Headers of the group of a frame. */
  info(place?: number): SlfInfo;
  /** What decode(place) gives and takes with these options; of a frame that is not predicted. */
  preflight(place: number, options?: SlfOptions): SlfEstimate;
  /** In order each frame is decoded once; elsewhere from the beginning of its group. READ_FAILED where bytes were dropped. */
  decode(place: number): SlfField;
  dropBefore(place: number): void;
  /** The bytes pushed next are those from `offset` of a frame on that is not predicted. All that is held is dropped. */
  seek(place: number): void;
  release(): void;
}

export interface SlfOpenOptions {
  signal?: AbortSignal;
  headers?: Record<string, string>;
  credentials?: RequestCredentials;
  /** NETWORK where nothing comes for so long, more than 0 [30000]; Infinity: it may take for ever. */
  stallMs?: number;
}

/** The package's decoder, compiled once a page. */
export function decoderModule(options?: SlfParts): Promise<WebAssembly.Module>;
