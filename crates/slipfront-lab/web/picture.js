// @ts-check
// The field as a WebGL2 picture with one pixel for each block: bytes in one texture, their colours in
// another. The browser enlarges it: without a graphics card that takes half the time of drawing every pixel
// of the screen here.

const CORNERS = `#version 300 es
void main() {
  vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}`;

const COLOURS = `#version 300 es
precision highp float;
uniform highp sampler2D values;
uniform sampler2D colours;
out vec4 colour;
void main() {
  int value = int(texelFetch(values, ivec2(gl_FragCoord.xy), 0).r * 255.0 + 0.5);
  colour = texelFetch(colours, ivec2(value, 0), 0);
}`;

/** @param {WebGL2RenderingContext} gl @param {number} kind @param {string} text */
function shader(gl, kind, text) {
  const made = /** @type {WebGLShader} */ (gl.createShader(kind));
  gl.shaderSource(made, text);
  gl.compileShader(made);
  return made;
}

/** @param {WebGL2RenderingContext} gl @param {number} unit */
function texture(gl, unit) {
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
}

export class Picture {
  /** @param {HTMLCanvasElement} canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.gl = canvas.getContext('webgl2', { antialias: false, alpha: false, depth: false });
    this.size = [0, 0];
    if (this.gl) this.prepare(this.gl);
  }

  /** @param {WebGL2RenderingContext} gl */
  prepare(gl) {
    const program = gl.createProgram();
    gl.attachShader(program, shader(gl, gl.VERTEX_SHADER, CORNERS));
    gl.attachShader(program, shader(gl, gl.FRAGMENT_SHADER, COLOURS));
    gl.linkProgram(program);
    gl.useProgram(program);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    texture(gl, 1);
    texture(gl, 0);
    gl.uniform1i(gl.getUniformLocation(program, 'values'), 0);
    gl.uniform1i(gl.getUniformLocation(program, 'colours'), 1);
    this.size = [0, 0];
  }

  /** The colours of the bytes. @param {Uint8Array} bytes */
  colour(bytes) {
    const { gl } = this;
    if (!gl) return;
    gl.activeTexture(gl.TEXTURE1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    gl.activeTexture(gl.TEXTURE0);
  }

  /** Takes the values of a new picture. @param {{nx: number, ny: number, bytes: Uint8Array}} picture */
  take({ nx, ny, bytes }) {
    const { gl } = this;
    if (!gl) return;
    if (this.size[0] === nx && this.size[1] === ny) {
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, nx, ny, gl.RED, gl.UNSIGNED_BYTE, bytes);
    } else {
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, nx, ny, 0, gl.RED, gl.UNSIGNED_BYTE, bytes);
      this.size = [nx, ny];
      this.canvas.width = nx;
      this.canvas.height = ny;
      gl.viewport(0, 0, nx, ny);
    }
  }

  /** Draws the values that were taken last. */
  draw() {
    this.gl?.drawArrays(this.gl.TRIANGLES, 0, 3);
  }

  /** Puts the picture where `camera` sees it. @param {import('./camera.js').Camera} camera */
  place(camera) {
    const [left, top] = camera.toPixels([0, camera.blocks[1]]);
    const { style } = this.canvas;
    style.width = `${camera.blocks[0] * camera.scale}px`;
    style.height = `${camera.blocks[1] * camera.scale}px`;
    style.transform = `translate(${left}px, ${top}px)`;
  }
}
