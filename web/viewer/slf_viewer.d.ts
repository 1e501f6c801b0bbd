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
  ready: CustomEvent<{ points: number }>;
  error: CustomEvent<ViewerError>;
  viewchange: CustomEvent<undefined>;
  annotation: CustomEvent<{ index: number; title: string }>;
  noteserror: CustomEvent<ViewerError>;
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
  /** A track of the notes, by name or number; stops the one that plays. */
  play(track?: string | number): void;
  /** An annotation of the notes, by its number from 0. */
  show(annotation: number): void;
  reset(): void;
  fit(): void;
  /** Degrees a second; 0 stops. */
  spin(speed?: number): void;
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
