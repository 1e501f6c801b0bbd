// SPDX-License-Identifier: Apache-2.0
// A static server of one folder, open to other origins, that packs what it sends and counts it.
import { existsSync, readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join } from 'node:path';
import { gzipSync } from 'node:zlib';

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.css': 'text/css',
  '.wasm': 'application/wasm' };

/** @returns {Promise<{url, sent, close}>} sent(): files and bytes since the last call, but .slf and pages */
export async function serveFolder(root, headers = {}) {
  let files = 0, bytes = 0;
  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://x').pathname);
    const file = join(root, path.endsWith('/') ? `${path}index.html` : path);
    if (!existsSync(file) || !statSync(file).isFile()) return response.writeHead(404, headers).end();
    const kind = extname(file), packed = gzipSync(readFileSync(file), { level: 9 });
    if (kind !== '.slf' && kind !== '.html') {
      ++files;
      bytes += packed.length;
    }
    response.writeHead(200, { 'content-type': TYPES[kind] ?? 'application/octet-stream', 'content-encoding': 'gzip',
      'content-length': packed.length, 'access-control-allow-origin': '*', ...headers });
    response.end(packed);
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  return {
    url: `http://127.0.0.1:${server.address().port}`,
    sent() {
      const counted = { files, bytes };
      files = bytes = 0;
      return counted;
    },
    close() {
      server.closeAllConnections();
      server.close();
    },
  };
}
