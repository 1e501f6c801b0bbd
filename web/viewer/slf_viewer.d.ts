// SPDX-License-Identifier: Apache-2.0
// Types of slf_viewer.js: <slf-viewer>.
import type { SLFParts } from './SLFLoader.js';
import type { ViewerError } from './packed_field.js';

/** A view as attributes and addresses have it; degrees, and world units of the target: "x,y,z". */
export interface SlfView {
  azimuth: string;
  elevation: string;
  fov: string;
  zoom: string;
  target: string;
  [parameter: string]: string;
}

export interface SlfViewerEvents {
  progress: CustomEvent<{ received: number; total: number }>;
  coarse: CustomEvent<{ points: number }>;
  /** coarser: levels and groups that are shown (0: all), where memory holds no more; else null. */
  ready: CustomEvent<{ points: number; coarser: { levels: number; groups: number } | null }>;
  error: CustomEvent<ViewerError>;
  viewchange: CustomEvent<undefined>;
  annotation: CustomEvent<{ index: number; title: string }>;
  noteserror: CustomEvent<ViewerError>;
  /** Two points of the object and how far they are apart, in units of the world and in metres; null: nobody knows these. */
  measure: CustomEvent<{ from: number[]; to: number[]; units: number; metres: number | null }>;
  play: CustomEvent<undefined>;
  pause: CustomEvent<undefined>;
  /** The last frame was shown, and there is no loop. */
  ended: CustomEvent<undefined>;
  /** frame: its place from 0; number as the file has it; seconds. */
  framechange: CustomEvent<{ frame: number; number: number; time: number }>;
  xrstart: CustomEvent<{ mode: 'immersive-vr' | 'immersive-ar' }>;
  xrend: CustomEvent<{ mode: 'immersive-vr' | 'immersive-ar' }>;
  /** It is passed over. */
  frameerror: CustomEvent<{ frame: number; number: number; error: ViewerError }>;
}

/** Attributes: viewer/README.md. */
export class SlfViewerElement extends HTMLElement {
  /** Where the package's files are, if not beside its code; holds for every viewer of the page. */
  static parts: SLFParts;

  /** 'idle', 'loading', 'coarse', 'ready', or 'failed' and the kind of the error. */
  readonly state: string;
  /** null before something shows. Set to parts of a view, the rest is as the attributes have it. */
  get view(): SlfView | null;
  set view(view: Partial<Record<keyof SlfView, string | number>> | null);

  /** In place of `src`. Resolves when it shows, or what is wrong does. */
  open(source: string | Blob | Uint8Array, name?: string): Promise<void>;
  /** The place of the object under a point of the window, in world units; null beside it. */
  pointAt(x: number, y: number): [number, number, number] | null;
  /** What moves. With a track of the notes, by name or number, and where nothing moves: a tour; stops the one that plays. */
  play(track?: string | number): void;
  pause(): void;
  readonly paused: boolean;
  /** Place of the frame that shows, from 0. Set: it shows as soon as it is decoded. */
  frame: number;
  /** Those that have arrived; 0 where nothing moves. */
  readonly frames: number;
  /** Seconds of the frames that have arrived. */
  readonly duration: number;
  loop: boolean;
  /** 1: as the file has it; 1/16 to 16. */
  speed: number;
  /** An annotation of the notes, by its number from 0. */
  show(annotation: number): void;
  /** Whether clicks on the object measure it. */
  measure(on?: boolean): void;
  reset(): void;
  fit(): void;
  /** Degrees a second; 0 stops. */
  spin(speed?: number): void;
  /** Into a room of WebXR, or out of it. In a handler of a click: browsers ask for that. */
  toggleRoom(kind: 'vr' | 'ar'): Promise<void>;
  /** PNG of what is shown; null before. */
  picture(): Promise<Blob | null>;

  addEventListener<K extends keyof SlfViewerEvents>(
    type: K, listener: (event: SlfViewerEvents[K]) => void, options?: boolean | AddEventListenerOptions): void;
  addEventListener(type: string, listener: EventListenerOrEventListenerObject, options?: boolean | AddEventListenerOptions): void;
}

declare global {
  interface HTMLElementTagNameMap {
    'slf-viewer': SlfViewerElement;
  }
}
