// SPDX-License-Identifier: Apache-2.0
// Prints what a decode costs under node: the first of a process, as a page has it, and the ones after it.
//   node web/test/bench.js FILE.slf [WASM]
// Milliseconds: wall; CPU of the process (user; the compiler's threads count in); CPU of the thread that
// decodes (Linux), which is what a page waits for where there are two cores.
import { existsSync, readFileSync } from 'node:fs';
import { pathToFileURL } from 'node:url';
import { SlfDecoder } from '../slf_node.js';

const [file, wasm] = process.argv.slice(2);
const bytes = readFileSync(file);

const SCHEDULED = `/proc/self/task/${process.pid}/schedstat`;
function threadMs() {
  return existsSync(SCHEDULED) ? Number(readFileSync(SCHEDULED, 'utf8').split(' ')[0]) / 1e6 : NaN;
}

function timed(body) {
  const cpu = process.cpuUsage(), wall = performance.now(), thread = threadMs();
  const result = body();
  return { thread: threadMs() - thread, wall: performance.now() - wall, cpu: process.cpuUsage(cpu).user / 1000, result };
}

const beforeCompile = process.cpuUsage();
const decoder = await SlfDecoder.create(wasm ? { wasm: pathToFileURL(wasm) } : {});
const compile = process.cpuUsage(beforeCompile).user / 1000;
const times = [];
for (let i = 0; i < 8; ++i) {
  const once = timed(() => decoder.decode(bytes));
  times.push(once);
  once.result.release();
}
const best = (name) => Math.min(...times.slice(1).map((t) => t[name]));
const ms = (x) => x.toFixed(0).padStart(6);
console.log(`compile       cpu ${ms(compile)}`);
console.log(`first decode  cpu ${ms(times[0].cpu)}, thread ${ms(times[0].thread)}, wall ${ms(times[0].wall)}`);
console.log(`later, best   cpu ${ms(best('cpu'))}, thread ${ms(best('thread'))}, wall ${ms(best('wall'))}`);
