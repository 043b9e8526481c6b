// @ts-check
// The field as a WebGL2 picture: bytes in one texture, their colours in another, looked up for every pixel.

const CORNERS = `#version 300 es
void main() {
  vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}`;

const COLOURS = `#version 300 es
precision highp float;
uniform highp sampler2D values;
uniform sampler2D colours;
uniform vec2 corner;
uniform float pixel;
uniform vec4 background;
out vec4 colour;
void main() {
  ivec2 block = ivec2(floor(corner + gl_FragCoord.xy * pixel));
  ivec2 size = textureSize(values, 0);
  if (any(lessThan(block, ivec2(0))) || any(greaterThanEqual(block, size))) {
    colour = background;
  } else {
    int value = int(texelFetch(values, block, 0).r * 255.0 + 0.5);
    colour = texelFetch(colours, ivec2(value, 0), 0);
  }
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
    this.gl = canvas.getContext('webgl2', { antialias: false, alpha: false });
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
    this.places = Object.fromEntries(['values', 'colours', 'corner', 'pixel', 'background'].map((name) => [name, gl.getUniformLocation(program, name)]));
    gl.uniform1i(this.places.values, 0);
    gl.uniform1i(this.places.colours, 1);
    this.size = [0, 0];
  }

  /** The colours of the bytes, and of what is beside the slider. @param {Uint8Array} bytes @param {Uint8Array} background */
  colour(bytes, background) {
    if (!this.gl || !this.places) return;
    this.gl.activeTexture(this.gl.TEXTURE1);
    this.gl.texImage2D(this.gl.TEXTURE_2D, 0, this.gl.RGBA8, 256, 1, 0, this.gl.RGBA, this.gl.UNSIGNED_BYTE, bytes);
    this.gl.activeTexture(this.gl.TEXTURE0);
    this.gl.uniform4f(this.places.background, background[0] / 255, background[1] / 255, background[2] / 255, 1);
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
    }
  }

  /** Draws what `camera` sees; pixels of the canvas are `ratio` times finer than those of the camera. @param {import('./camera.js').Camera} camera @param {number} ratio */
  draw(camera, ratio) {
    const { gl, places } = this;
    if (!gl || !places) return;
    const [left, bottom] = camera.toBlocks([0, camera.pixels[1]]);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.uniform2f(places.corner, left, bottom);
    gl.uniform1f(places.pixel, 1 / (camera.scale * ratio));
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}
