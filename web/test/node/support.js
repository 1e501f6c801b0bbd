// SPDX-License-Identifier: Apache-2.0
// What the tests share: the conformance suite, and a server that can be told to misbehave.
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { fileURLToPath } from 'node:url';
import { join } from 'node:path';

export const suite = fileURLToPath(new URL('../../../conformance', import.meta.url));

/** [{id, stream, ...case.json}] of streams/ or refused/. */
export function cases(part) {
  const root = join(suite, part);
  return readdirSync(root).sort().map((id) => {
    const about = JSON.parse(readFileSync(join(root, id, 'case.json')));
    return { ...about, id, bytes: readFileSync(join(root, id, about.stream.file)) };
  });
}

export function caseOf(id) { return cases('streams').find((one) => one.id === id); }

export function digest(array) {
  return createHash('sha256').update(Buffer.from(array.buffer, array.byteOffset, array.byteLength)).digest('hex');
}

/** Options of a decode as a case states them. */
export function optionsOf({ levels = 0, groups = 0, layers = 0, region }) {
  return { levels, groups, layers, region: region && { low: region.slice(0, 3), high: region.slice(3) } };
}

/** How a server answers a request for bytes begin .. end - 1. */
const MANNERS = {
  'nothing at first': (response, bytes, begin, end, count) => {
    if (count === 0) return response.destroy();
    part(response, bytes, begin, end);
  },
  ranges: (response, bytes, begin, end) => part(response, bytes, begin, end),
  whole: (response, bytes) => {
    response.writeHead(200, { 'Content-Length': bytes.length });
    response.end(bytes);
  },
  'another part': (response, bytes, begin, end) => part(response, bytes, begin === 0 ? 0 : begin - 1, end),
  'no Content-Range': (response, bytes, begin, end) => {
    response.writeHead(206, { 'Content-Length': end - begin });
    response.end(bytes.subarray(begin, end));
  },
  'less than it says': (response, bytes, begin, end) => {
    response.writeHead(206, { 'Content-Range': `bytes ${begin}-${end - 1}/${bytes.length}`, 'Transfer-Encoding': 'chunked' });
    response.end(bytes.subarray(begin, Math.max(begin, end - 7)));
  },
  'more than it says': (response, bytes, begin, end) => {
    response.writeHead(206, { 'Content-Range': `bytes ${begin}-${end - 1}/${bytes.length}`, 'Transfer-Encoding': 'chunked' });
    response.end(Buffer.concat([bytes.subarray(begin, end), Buffer.alloc(9)]));
  },
  'another size': (response, bytes, begin, end) => part(response, bytes, begin, end, bytes.length + (begin > 0 ? 1 : 0)),
  'cut off': (response, bytes, begin, end) => {
    response.writeHead(206, { 'Content-Range': `bytes ${begin}-${end - 1}/${bytes.length}`, 'Content-Length': end - begin });
    response.write(bytes.subarray(begin, begin + Math.floor((end - begin) / 2)), () => response.destroy());
  },
  stalls: (response, bytes, begin, end) => {
    response.writeHead(206, { 'Content-Range': `bytes ${begin}-${end - 1}/${bytes.length}`, 'Content-Length': end - begin });
    response.write(bytes.subarray(begin, begin + 1));
  },
  missing: (response) => {
    response.writeHead(404);
    response.end();
  },
};
export const manners = Object.keys(MANNERS);

function part(response, bytes, begin, end, size = bytes.length) {
  response.writeHead(206, { 'Content-Range': `bytes ${begin}-${end - 1}/${size}`, 'Content-Length': end - begin });
  response.end(bytes.subarray(begin, end));
}

/** Serves files by name; /NAME?manner=M&after=N misbehaves from request N on. */
export async function serve(files) {
  const requests = [];
  const server = createServer((request, response) => {
    const url = new URL(request.url, 'http://localhost');
    const bytes = files[url.pathname.slice(1)];
    const range = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? '');
    if (range && range[2] === '') range[2] = String(bytes.length - 1);
    const count = requests.filter((one) => one.url === request.url).length;
    requests.push({ url: request.url, range: range && [Number(range[1]), Number(range[2]) + 1] });
    const manner = count >= Number(url.searchParams.get('after') ?? 0) ? url.searchParams.get('manner') : 'ranges';
    if (!bytes) return MANNERS.missing(response);
    if (!range && manner !== 'missing') return MANNERS.whole(response, bytes);
    MANNERS[manner ?? 'ranges'](response, bytes, Number(range[1]), Math.min(Number(range[2]) + 1, bytes.length), count);
  });
  server.keepAliveTimeout = 600000; // a decode in this process lets the server wait
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return {
    url: (name, query = '') => `http://127.0.0.1:${server.address().port}/${name}${query}`,
    requests,
    close: () => new Promise((resolve) => {
      server.closeAllConnections();
      server.close(resolve);
    }),
  };
}
