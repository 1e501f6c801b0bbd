// three.js loader of surface light fields.
//
//   import { SLFLoader } from '@slf/viewer/SLFLoader.js'
//   scene.add(await new SLFLoader().loadAsync('can.slf'))
import { FileLoader, Loader } from 'three';
import { FieldLoader } from './field_loader.js';
import { DecodeSession, plainError } from './decode_session.js';
import { ViewerError } from './packed_field.js';
import { SurfaceLightField } from './surface_light_field.js';

/** One decoder for parse() of all loaders: each keeps memory for its next decode. */
let decoder = null;
function sharedDecoder() {
  decoder ??= import('../slf.js')
    .then(({ SlfDecoder }) => SlfDecoder.create())
    .catch((error) => {
      decoder = null; // to be tried again
      throw error;
    });
  return decoder;
}

/**
 * load(url, onLoad, onProgress, onError), loadAsync(url, onProgress) as every loader of three; both also
 * take a File or Blob. They decode in a worker. parse() decodes on this thread.
 */
export class SLFLoader extends Loader {
  constructor(manager) {
    super(manager);
    this.part = {};
    this.maxMemory = 2 ** 31;
  }

  /** Fewer octree levels, plane groups or quality layers than the file has; 0: all. */
  setPart({ levels = 0, groups = 0, layers = 0 }) {
    this.part = { levels, groups, layers };
    return this;
  }

  load(url, onLoad, onProgress, onError) {
    const manager = this.manager,
      named = url instanceof Blob ? 'file' : url;
    manager.itemStart(named);
    this.fetch(url, onProgress)
      .then((bytes) => this.decode(bytes))
      .then((object) => {
        onLoad(object);
        manager.itemEnd(named);
      })
      .catch((error) => {
        if (onError) onError(error);
        else console.error(error);
        manager.itemError(named);
        manager.itemEnd(named);
      });
  }

  /** Coarse objects first. @param onCoarse  called with each, which the next replaces */
  async stream(url, onCoarse) {
    const loader = new FieldLoader({ maxMemory: this.maxMemory });
    try {
      const field = (packed, info, final) => {
        if (!final) onCoarse(new SurfaceLightField(packed, info));
      };
      const { packed, info } = await loader.load(
        this.manager.resolveURL(this.path + url),
        { field },
        {
          ...this.part,
          headers: this.requestHeader,
          credentials: this.withCredentials ? 'include' : 'same-origin', // as three's own FileLoader
        },
      );
      return new SurfaceLightField(packed, info);
    } finally {
      loader.dispose();
    }
  }

  /**
   * @param {ArrayBuffer|Uint8Array} buffer  a whole file
   * @returns {Promise<SurfaceLightField>}
   * @throws {ViewerError} kind 'damaged', 'unsupported', 'too-large', 'memory', 'no-view-maps', 'network'
   */
  async parse(buffer) {
    const session = new DecodeSession(sharedDecoder);
    session.append(new Uint8Array(buffer));
    try {
      const { packed, info } = await session.decode({ ...this.part, maxMemory: this.maxMemory });
      return new SurfaceLightField(packed, info);
    } catch (error) {
      throw ViewerError.from(plainError(error));
    }
  }

  async fetch(url, onProgress) {
    if (url instanceof Blob) return url.arrayBuffer();
    const loader = new FileLoader(this.manager);
    loader.setPath(this.path);
    loader.setResponseType('arraybuffer');
    loader.setRequestHeader(this.requestHeader);
    loader.setWithCredentials(this.withCredentials);
    return loader.loadAsync(url, onProgress);
  }

  async decode(bytes) {
    const loader = new FieldLoader({ maxMemory: this.maxMemory });
    try {
      const { packed, info } = await loader.load(bytes, {}, this.part);
      return new SurfaceLightField(packed, info);
    } finally {
      loader.dispose();
    }
  }
}
