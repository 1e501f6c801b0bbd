// SPDX-License-Identifier: Apache-2.0
// Workers that start wherever this code came from: browsers refuse a worker whose script is of another origin, and some
// bundlers leave it out.
import { invalid } from './slf_arguments.js';
import { SlfError } from './slf_error.js';

/**
 * @param {() => Worker} own  starts it from its own address; it posts {ready: true} when it runs
 * @param {() => Promise<{text: string}>} copy  the same script in one piece, fetched only where `own` does not start
 * @returns {Promise<Worker>} that has started
 * @throws {SlfError} code NETWORK; its cause is what the second try met. INVALID_ARGUMENT where there are no workers
 */
export async function startWorker(own, copy) {
  if (typeof Worker === 'undefined') throw invalid('worker', 'must be given where there is no Worker, as in node');
  try {
    return await started(own());
  } catch {
    // Its script is of another origin, not there, or forbidden. The second try says why it fails, if it does.
  }
  let address;
  try {
    const { text } = await copy();
    address = URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));
    return await started(new Worker(address));
  } catch (cause) {
    throw new SlfError('NETWORK', `NETWORK: the worker cannot start: ${cause?.message ?? 'its script is refused'}`, { cause });
  } finally {
    if (address) URL.revokeObjectURL(address);
  }
}

function started(worker) {
  return new Promise((resolve, reject) => {
    worker.onmessage = () => {
      worker.onmessage = worker.onerror = null;
      resolve(worker);
    };
    worker.onerror = (event) => {
      event.preventDefault?.();
      worker.terminate();
      reject(new Error(event.message || 'its script cannot be fetched'));
    };
  });
}
