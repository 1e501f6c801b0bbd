// SPDX-License-Identifier: Apache-2.0
// The error of every module here.

/** What went wrong. code: as in include/slf/slf.h without SLF_ ("OUT_OF_RANGE"), or "NETWORK", "ABORTED", "POLICY". */
export class SlfError extends Error {
  constructor(code, message, details = {}) {
    super(message, details.cause === undefined ? undefined : { cause: details.cause });
    this.name = 'SlfError';
    this.code = code;
    this.element = details.element ?? '';
    this.unit = details.unit ?? '';
    this.bitOffset = details.bitOffset ?? 0;
  }
}
