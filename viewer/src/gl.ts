// The little of WebGL2 that the page needs: programs, and buffers that are filled anew for each picture.

export class Program {
  readonly handle: WebGLProgram;
  private uniforms = new Map<string, WebGLUniformLocation | null>();

  constructor(
    private gl: WebGL2RenderingContext,
    vertex: string,
    fragment: string,
  ) {
    this.handle = gl.createProgram()!;
    for (const [type, source] of [
      [gl.VERTEX_SHADER, vertex],
      [gl.FRAGMENT_SHADER, fragment],
    ] as const) {
      const shader = gl.createShader(type)!;
      gl.shaderSource(shader, "#version 300 es\nprecision highp float;\n" + source);
      gl.compileShader(shader);
      gl.attachShader(this.handle, shader);
    }
    gl.linkProgram(this.handle);
    if (!gl.getProgramParameter(this.handle, gl.LINK_STATUS))
      throw new Error(gl.getProgramInfoLog(this.handle) ?? "");
  }

  set(name: string, ...values: number[]): void {
    if (!this.uniforms.has(name)) this.uniforms.set(name, this.gl.getUniformLocation(this.handle, name));
    const place = this.uniforms.get(name)!;
    if (values.length === 1) this.gl.uniform1f(place, values[0]);
    else if (values.length === 3) this.gl.uniform3f(place, values[0], values[1], values[2]);
    else this.gl.uniform2f(place, values[0], values[1]);
  }
}

/** Numbers per vertex (or per instance): `sizes` floats for attribute 0, 1, ... */
export class Buffer {
  private array: WebGLVertexArrayObject;
  private data: WebGLBuffer;
  private bytes = 0;

  constructor(
    private gl: WebGL2RenderingContext,
    sizes: number[],
    perInstance = false,
  ) {
    this.array = gl.createVertexArray()!;
    this.data = gl.createBuffer()!;
    gl.bindVertexArray(this.array);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.data);
    const stride = 4 * sizes.reduce((sum, size) => sum + size, 0);
    let offset = 0;
    sizes.forEach((size, location) => {
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, size, gl.FLOAT, false, stride, offset);
      if (perInstance) gl.vertexAttribDivisor(location, 1);
      offset += 4 * size;
    });
    gl.bindVertexArray(null);
  }

  fill(values: Float32Array): void {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.data);
    if (values.byteLength > this.bytes) gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    else gl.bufferSubData(gl.ARRAY_BUFFER, 0, values);
    this.bytes = Math.max(this.bytes, values.byteLength);
  }

  bind(): void {
    this.gl.bindVertexArray(this.array);
  }
}

/** Triangles by their corners; attribute k has a buffer of its own, with sizes[k] floats per vertex. */
export class Mesh {
  private array: WebGLVertexArrayObject;
  private data: WebGLBuffer[];
  private corners: WebGLBuffer;
  private count = 0;

  constructor(
    private gl: WebGL2RenderingContext,
    sizes: number[],
  ) {
    this.array = gl.createVertexArray()!;
    this.corners = gl.createBuffer()!;
    gl.bindVertexArray(this.array);
    this.data = sizes.map((size, location) => {
      const buffer = gl.createBuffer()!;
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(location);
      gl.vertexAttribPointer(location, size, gl.FLOAT, false, 0, 0);
      return buffer;
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.corners);
    gl.bindVertexArray(null);
  }

  /** Three vertices of each triangle. */
  index(corners: Uint32Array): void {
    const { gl } = this;
    gl.bindVertexArray(this.array);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, corners, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    this.count = corners.length;
  }

  fill(attribute: number, values: Float32Array): void {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.data[attribute]);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
  }

  draw(): void {
    const { gl } = this;
    gl.bindVertexArray(this.array);
    gl.drawElements(gl.TRIANGLES, this.count, gl.UNSIGNED_INT, 0);
  }
}

/** A picture that is not shown; while it is bound as a texture, shaders read its pixels. */
export class Offscreen {
  private frame: WebGLFramebuffer;
  private texture: WebGLTexture;

  constructor(private gl: WebGL2RenderingContext) {
    this.frame = gl.createFramebuffer()!;
    this.texture = gl.createTexture()!;
  }

  /** What is drawn from now on goes here, without blending. */
  begin(width: number, height: number): void {
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.texture, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.disable(gl.BLEND);
  }

  end(): void {
    this.gl.bindFramebuffer(this.gl.FRAMEBUFFER, null);
    this.gl.enable(this.gl.BLEND);
  }
}
