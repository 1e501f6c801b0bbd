// SPDX-License-Identifier: Apache-2.0
// Programs, textures and frame buffers of WebGL 2, each made in one call.

/** Compiled and linked, with the places of its uniforms. @throws Error with the compiler's own words */
export function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  const shadersOf = [
    [gl.VERTEX_SHADER, vertex],
    [gl.FRAGMENT_SHADER, fragment],
  ].map(([type, source]) => {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
    return shader;
  });
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) {
    const log = shadersOf.map((shader) => gl.getShaderInfoLog(shader)).join('\n');
    throw new Error(`A shader does not compile: ${log} ${gl.getProgramInfoLog(made)}`);
  }
  const uniforms = {};
  for (let i = 0, n = gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); i < n; ++i) {
    const { name } = gl.getActiveUniform(made, i);
    uniforms[name] = gl.getUniformLocation(made, name);
  }
  for (const shader of shadersOf) gl.deleteShader(shader);
  return { program: made, uniforms };
}

export function use(gl, { program, uniforms }) {
  gl.useProgram(program);
  return uniforms;
}

/** Textures to units from `unit` on, those that the program has. */
export function bind(gl, uniforms, textures, kind = gl.TEXTURE_2D, unit = 0) {
  for (const [name, texture] of Object.entries(textures)) {
    if (!(name in uniforms)) continue;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(kind, texture);
    gl.uniform1i(uniforms[name], unit++);
  }
}

export function image(gl, internal, width, height, format, type, data) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  unpackPlainly(gl);
  gl.texStorage2D(gl.TEXTURE_2D, 1, internal, width, height);
  if (data) gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, format, type, data);
  sample(gl, gl.TEXTURE_2D, gl.NEAREST);
  return texture;
}

export function layered(gl, internal, width, height, layers, filter) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
  gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, internal, width, height, layers);
  sample(gl, gl.TEXTURE_2D_ARRAY, filter);
  return texture;
}

/** Texels into the first rows of a texture. */
export function putImage(gl, texture, width, height, format, type, data) {
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  unpackPlainly(gl);
  gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, format, type, data);
}

/** The same of each layer. */
export function putLayers(gl, texture, width, height, layers, format, type, data) {
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
  unpackPlainly(gl);
  gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, 0, width, height, layers, format, type, data);
}

export function unpackPlainly(gl) {
  gl.bindBuffer(gl.PIXEL_UNPACK_BUFFER, null);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
  gl.pixelStorei(gl.UNPACK_FLIP_Y_WEBGL, false);
  gl.pixelStorei(gl.UNPACK_PREMULTIPLY_ALPHA_WEBGL, false);
}

export function sample(gl, kind, filter) {
  gl.texParameteri(kind, gl.TEXTURE_MIN_FILTER, filter);
  gl.texParameteri(kind, gl.TEXTURE_MAG_FILTER, filter);
  gl.texParameteri(kind, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(kind, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
}

export function target(gl, colours, depth) {
  const buffer = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, buffer);
  colours.forEach((texture, i) =>
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, texture, 0),
  );
  if (depth) gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depth, 0);
  gl.drawBuffers(colours.length ? colours.map((_, i) => gl.COLOR_ATTACHMENT0 + i) : [gl.NONE]);
  return buffer;
}

/** Two triangles for each of `quads` discs: vertices 4 i .. 4 i + 3. */
export function quadIndices(gl, quads) {
  const indices = new Uint32Array(6 * quads);
  for (let i = 0; i < quads; ++i)
    indices.set(
      [0, 1, 2, 2, 1, 3].map((corner) => 4 * i + corner),
      6 * i,
    );
  const array = gl.createVertexArray(),
    buffer = gl.createBuffer();
  gl.bindVertexArray(array);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.STATIC_DRAW);
  gl.bindVertexArray(null);
  return { array, buffer };
}
