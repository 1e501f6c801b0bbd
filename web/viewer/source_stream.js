// SPDX-License-Identifier: Apache-2.0
// A file, an address or bytes as chunks, and what may be wrong on their way.
import { ViewerError } from './packed_field.js';

export const aborted = () => new DOMException('Another file was opened.', 'AbortError');

/** Chunks of a source, and how many bytes there will be; 0 where nobody says. exact: and no fewer. */
export async function openStream(source, request, stallMs) {
  if (source instanceof ArrayBuffer) source = new Uint8Array(source);
  if (source instanceof Uint8Array) return { total: source.length, exact: true, chunks: [source] };
  const reads = (read) => within(stallMs, read);
  if (source instanceof Blob) return { total: source.size, exact: true, chunks: chunksOf(source.stream()) };
  let response;
  try {
    response = await reads(fetch(source, request));
  } catch (error) {
    if (request.signal.aborted) throw aborted();
    if (error instanceof ViewerError) throw error;
    throw new ViewerError('network', 'The file cannot be fetched.', String(source));
  }
  if (!response.ok)
    throw new ViewerError('network', `The server says ${response.status}.`, `${source} ${response.statusText}`);
  const packed = response.headers.get('content-encoding'); // then the length is that before unpacking
  const total = packed ? 0 : Number(response.headers.get('content-length') ?? 0);
  // Whether that is so is not seen of another origin.
  return { total, exact: total > 0 && response.type !== 'cors', chunks: chunksOf(response.body, reads) };
}

/** What a server promised; 'network' where it stays silent. */
async function within(ms, promise) {
  let timer;
  const silence = new Promise((_, reject) => {
    const error = new ViewerError('network', `The server has sent nothing for ${ms / 1000} seconds.`);
    timer = setTimeout(reject, ms, error);
  });
  return Promise.race([promise, silence]).finally(() => clearTimeout(timer));
}

/** @param {(read: Promise) => Promise} reads  what is done with each read */
async function* chunksOf(stream, reads = (read) => read) {
  const reader = stream.getReader();
  try {
    for (;;) {
      const { done, value } = await reads(reader.read());
      if (done) return;
      yield value;
    }
  } catch (error) {
    if (error?.name === 'AbortError' || error instanceof ViewerError) throw error;
    throw new ViewerError('network', 'The connection broke.');
  } finally {
    reader.cancel().catch(() => {}); // where it was given up
  }
}
