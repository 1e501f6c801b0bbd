// SPDX-License-Identifier: Apache-2.0
// Types of viewer.js: the viewer page's own object. It needs the elements of viewer.html.
import type { SlfInfo } from '../slf.js';

/** Defaults of the address's parameters (README.md), for a page of its own. */
export interface ViewerPage {
  src?: string;
  title?: string;
  background?: string;
  embed?: boolean;
  levels?: number;
  groups?: number;
  layers?: number;
  /** Bytes of a file that is shown at once, and its name. */
  file?: Uint8Array;
  name?: string;
  [parameter: string]: unknown;
}

/** What is known of the file that is shown; times in milliseconds from open(). */
export interface ViewerFacts {
  name?: string;
  bytes?: number;
  info?: SlfInfo;
  first?: number;
  loaded?: number;
  psnr?: number;
}

/** Where a viewer is, if not on a page of its own: slf_viewer.js is an example. */
export interface ViewerPlace {
  /** Elements of elements.js; the document's. */
  elements?: unknown;
  /** What the address says; that of the page. */
  query?: { get(name: string): string | null };
  /** Address of a view; null: there is none. */
  link?: ((parameters: Record<string, string>) => string) | null;
  emit?: (name: string, detail?: unknown) => void;
}

export class Viewer {
  constructor(page?: ViewerPage, place?: ViewerPlace);
  readonly facts: ViewerFacts;

  /** An address, a File or bytes. Resolves when it shows, or what is wrong does. */
  open(source: string | Blob | Uint8Array, name?: string): Promise<void>;
  /** The first view, and all of the object in it. */
  reset(): void;
  fit(): void;
  /** Degrees a second; 0 stops. */
  spin(speed: number): void;
}
