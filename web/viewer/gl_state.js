// SPDX-License-Identifier: Apache-2.0
// The state of a WebGL context that somebody else draws with, too.

const FLAGS = ['BLEND', 'DEPTH_TEST', 'CULL_FACE', 'SCISSOR_TEST', 'STENCIL_TEST'];
const UNITS = 6;

/** Calls `draw` and leaves WebGL as it was, so that three's own record of it stays true. */
export function withState(gl, draw) {
  const get = (name) => gl.getParameter(gl[name]);
  const flags = FLAGS.map((name) => gl.isEnabled(gl[name]));
  const unit = get('ACTIVE_TEXTURE');
  const textures = Array.from({ length: UNITS }, (_, i) => {
    gl.activeTexture(gl.TEXTURE0 + i);
    return [get('TEXTURE_BINDING_2D'), get('TEXTURE_BINDING_2D_ARRAY'), get('SAMPLER_BINDING')];
  });
  for (let i = 0; i < UNITS; ++i) gl.bindSampler(i, null);
  const saved = Object.fromEntries(
    [
      'CURRENT_PROGRAM',
      'VERTEX_ARRAY_BINDING',
      'DRAW_FRAMEBUFFER_BINDING',
      'READ_FRAMEBUFFER_BINDING',
      'VIEWPORT',
      'BLEND_EQUATION_RGB',
      'BLEND_EQUATION_ALPHA',
      'BLEND_SRC_RGB',
      'BLEND_DST_RGB',
      'BLEND_SRC_ALPHA',
      'BLEND_DST_ALPHA',
      'DEPTH_FUNC',
      'DEPTH_WRITEMASK',
      'DEPTH_CLEAR_VALUE',
      'COLOR_WRITEMASK',
      'COLOR_CLEAR_VALUE',
      'PIXEL_UNPACK_BUFFER_BINDING',
      'UNPACK_ALIGNMENT',
      'UNPACK_FLIP_Y_WEBGL',
      'UNPACK_PREMULTIPLY_ALPHA_WEBGL',
    ].map((name) => [name, get(name)]),
  );
  try {
    draw();
  } finally {
    restore(gl, saved);
    FLAGS.forEach((name, i) => (flags[i] ? gl.enable(gl[name]) : gl.disable(gl[name])));
    textures.forEach(([plain, array, sampler], i) => {
      gl.activeTexture(gl.TEXTURE0 + i);
      gl.bindTexture(gl.TEXTURE_2D, plain);
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, array);
      gl.bindSampler(i, sampler);
    });
    gl.activeTexture(unit);
  }
}

function restore(gl, s) {
  gl.useProgram(gl.isProgram(s.CURRENT_PROGRAM) ? s.CURRENT_PROGRAM : null); // it may be deleted since
  gl.bindVertexArray(s.VERTEX_ARRAY_BINDING);
  gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, s.DRAW_FRAMEBUFFER_BINDING);
  gl.bindFramebuffer(gl.READ_FRAMEBUFFER, s.READ_FRAMEBUFFER_BINDING);
  gl.viewport(...s.VIEWPORT);
  gl.blendEquationSeparate(s.BLEND_EQUATION_RGB, s.BLEND_EQUATION_ALPHA);
  gl.blendFuncSeparate(s.BLEND_SRC_RGB, s.BLEND_DST_RGB, s.BLEND_SRC_ALPHA, s.BLEND_DST_ALPHA);
  gl.depthFunc(s.DEPTH_FUNC);
  gl.depthMask(s.DEPTH_WRITEMASK);
  gl.clearDepth(s.DEPTH_CLEAR_VALUE);
  gl.colorMask(...s.COLOR_WRITEMASK);
  gl.clearColor(...s.COLOR_CLEAR_VALUE);
  gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, s.PIXEL_UNPACK_BUFFER_BINDING);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, s.UNPACK_ALIGNMENT);
  gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, s.UNPACK_FLIP_Y_WEBGL);
  gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, s.UNPACK_PREMULTIPLY_ALPHA_WEBGL);
}
