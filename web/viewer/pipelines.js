// SPDX-License-Identifier: Apache-2.0
// Which pipeline draws a light field.
import { SplatPipeline } from './splat_pipeline.js';
import { SurfelPipeline } from './surfel_pipeline.js';

const kindOf = (packed) => (packed.splats ? SplatPipeline : SurfelPipeline);

/** A pipeline with the field in it: `before` where that is of its kind, else another in its place. @throws {ViewerError} */
export function pipelineWith(gl, packed, before = null) {
  const Kind = kindOf(packed);
  if (before instanceof Kind) {
    before.setField(packed);
    return before;
  }
  const made = new Kind(gl);
  try {
    made.setField(packed);
  } catch (error) {
    made.dispose();
    throw error;
  }
  before?.dispose();
  return made;
}
