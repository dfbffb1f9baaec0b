import { chainColour, Colouring } from "./colouring";
import { Drawing, inkOf, Look } from "./drawing";
import { Buffer, Offscreen, Program } from "./gl";
import {
  Box,
  boxOf,
  chainLines,
  ForceScale,
  forceScaleOf,
  grainColours,
  particleColours,
  Places,
  placesOf,
} from "./picture";
import { Run } from "./run";
import * as shaders from "./shaders";

/** Draws the packing of one run on a canvas. */
export class Renderer implements Drawing {
  run!: Run;
  places!: Places;
  forceScale: ForceScale | null = null;
  private gl: WebGL2RenderingContext;
  private fill: Program;
  private disk: Program;
  private cone: Program;
  private line: Program;
  private fills: Buffer;
  private disks: Buffer;
  private lines: Buffer;
  private numbers: Offscreen;
  private box: Box = { x0: 0, y0: 0, x1: 1, y1: 1 };
  private zoom = 1;
  private centre = [0, 0];

  /** Throws where the browser has no WebGL2. */
  constructor(private canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", { antialias: false });
    if (!gl) throw new Error("no WebGL2");
    this.gl = gl;
    this.fill = new Program(gl, shaders.FILL_VERTEX, shaders.FILL_FRAGMENT);
    this.disk = new Program(gl, shaders.DISK_VERTEX, shaders.DISK_FRAGMENT);
    this.cone = new Program(gl, shaders.DISK_VERTEX, shaders.CONE_FRAGMENT);
    this.line = new Program(gl, shaders.LINE_VERTEX, shaders.LINE_FRAGMENT);
    this.fills = new Buffer(gl, [2, 4]);
    this.disks = new Buffer(gl, [3, 4]);
    this.lines = new Buffer(gl, [4, 1, 4], true);
    this.numbers = new Offscreen(gl);
  }

  show(run: Run): void {
    this.run = run;
    this.box = boxOf(run);
    this.forceScale = forceScaleOf(run);
    this.reset();
  }

  reset(): void {
    this.zoom = 1;
    this.centre = [(this.box.x0 + this.box.x1) / 2, (this.box.y0 + this.box.y1) / 2];
  }

  /** Magnifies about a point of the picture [m]. */
  zoomAt(factor: number, at: [number, number]): void {
    const zoom = Math.min(64, Math.max(1, this.zoom * factor));
    const kept = this.zoom / zoom;
    this.zoom = zoom;
    if (zoom === 1) this.reset();
    else this.centre = this.centre.map((c, k) => at[k] + (c - at[k]) * kept);
  }

  pan(dx: number, dy: number): void {
    if (this.zoom > 1) this.centre = [this.centre[0] - dx, this.centre[1] - dy];
  }

  /** Width over height of the whole picture. */
  get aspect(): number {
    return (this.box.x1 - this.box.x0) / (this.box.y1 - this.box.y0 || 1);
  }

  /** CSS pixels per metre. */
  get pixelsPerMetre(): number {
    const { x0, x1, y0, y1 } = this.box;
    const margin = 14;
    const [width, height] = [this.canvas.clientWidth - margin, this.canvas.clientHeight - margin];
    return this.zoom * Math.min(width / (x1 - x0 || 1), height / (y1 - y0 || 1));
  }

  /** The point [m] under a place on the canvas [CSS pixels]. */
  toWorld(px: number, py: number): [number, number] {
    const s = this.pixelsPerMetre;
    const [w, h] = [this.canvas.clientWidth, this.canvas.clientHeight];
    return [this.centre[0] + (px - w / 2) / s, this.centre[1] - (py - h / 2) / s];
  }

  /** With `ratio` pixels for one of CSS. */
  draw(frame: number, look: Look, ratio = Math.min(2, window.devicePixelRatio || 1)): void {
    const { gl, canvas, run } = this;
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clearDepth(1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.places = placesOf(run, frame);
    const ink = inkOf(canvas);
    if (run.hasOutlines) this.drawGrains(frame, look.colouring);
    const points = !run.hasOutlines || look.colouring?.on === "particle";
    if (points && this.places.x.length > 0) this.drawPoints(frame, look.colouring);
    if (run.hasOutlines) this.drawLines(this.outlineLines([...ink, 0.75]), 1.1);
    if (look.highlight >= 0) this.drawLines(this.outlineLines([...ink, 1], look.highlight), 3.5);
    this.drawLines(this.wallLines([...ink, 1]), 3);
    const chainPaint = chainColour(look.colouring).map((c) => c / 255);
    if (look.chains && this.forceScale)
      this.drawLines(chainLines(run, frame, this.places, this.forceScale, chainPaint), 0.4);
  }

  private use(program: Program): void {
    const { gl, canvas } = this;
    gl.useProgram(program.handle);
    const s = this.pixelsPerMetre;
    program.set("centre", this.centre[0], this.centre[1]);
    program.set("scale", (2 * s) / canvas.clientWidth, (2 * s) / canvas.clientHeight);
  }

  private get devicePixels(): number {
    return (this.pixelsPerMetre * this.canvas.width) / this.canvas.clientWidth;
  }

  /** Each grain as triangles about its centroid. */
  private drawGrains(frame: number, colouring: Colouring | null): void {
    const { gl, run, places: p } = this;
    const rgb = colouring ? grainColours(run, frame, colouring) : new Float32Array(3 * run.grains).fill(0.6);
    const corners = new Float32Array(18 * p.outlineX.length);
    let at = 0;
    for (let g = 0; g < run.grains; ++g) {
      const [begin, end] = [run.outlineBegin[g], run.outlineBegin[g + 1]];
      const paint = [rgb[3 * g], rgb[3 * g + 1], rgb[3 * g + 2], g];
      for (let v = begin; v < end; ++v) {
        const w = v + 1 < end ? v + 1 : begin;
        corners.set([p.grainX[g], p.grainY[g], ...paint], at);
        corners.set([p.outlineX[v], p.outlineY[v], ...paint], at + 6);
        corners.set([p.outlineX[w], p.outlineY[w], ...paint], at + 12);
        at += 18;
      }
    }
    this.use(this.fill);
    this.fills.fill(corners);
    this.fills.bind();
    this.fill.set("numbers", 0);
    gl.drawArrays(gl.TRIANGLES, 0, corners.length / 6);
    if (colouring?.on !== "particle") return;
    this.numbers.begin(this.canvas.width, this.canvas.height);
    this.fill.set("numbers", 1);
    gl.drawArrays(gl.TRIANGLES, 0, corners.length / 6);
    this.numbers.end();
  }

  /** Primaries as disks; or material points, so large that they cover their grain, cut off at its outline. */
  private drawPoints(frame: number, colouring: Colouring | null): void {
    const { gl, run, places: p } = this;
    const inside = run.hasOutlines;
    const rgb = colouring ? particleColours(frame, colouring, p) : new Float32Array(3 * p.x.length).fill(0.6);
    const disks = new Float32Array(7 * p.x.length);
    for (let i = 0; i < p.x.length; ++i) {
      const radius = (inside ? 2.2 : 1) * (p.radius[i] ?? 0);
      disks.set([p.x[i], p.y[i], radius, rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], p.grain[i] ?? 0], 7 * i);
    }
    const program = inside ? this.cone : this.disk;
    this.use(program);
    program.set("pixels", this.devicePixels);
    program.set("rim", 1);
    if (inside) gl.enable(gl.DEPTH_TEST);
    this.disks.fill(disks);
    this.disks.bind();
    gl.drawArrays(gl.POINTS, 0, p.x.length);
    gl.disable(gl.DEPTH_TEST);
  }

  private drawLines(lines: Float32Array, thinnest: number): void {
    if (lines.length === 0) return;
    const { gl, canvas } = this;
    this.use(this.line);
    this.line.set("pixels", this.devicePixels);
    this.line.set("thinnest", (thinnest * canvas.width) / canvas.clientWidth);
    this.lines.fill(lines);
    this.lines.bind();
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.length / 9);
  }

  /** Of all grains, or of one. */
  private outlineLines(paint: number[], only = -1): Float32Array {
    const { run, places: p } = this;
    const lines: number[] = [];
    for (let g = 0; g < run.grains && run.hasOutlines; ++g) {
      if (only >= 0 && g !== only) continue;
      const [begin, end] = [run.outlineBegin[g], run.outlineBegin[g + 1]];
      for (let v = begin; v < end; ++v) {
        const w = v + 1 < end ? v + 1 : begin;
        lines.push(p.outlineX[v], p.outlineY[v], p.outlineX[w], p.outlineY[w], 0, ...paint);
      }
    }
    return new Float32Array(lines);
  }

  private wallLines(paint: number[]): Float32Array {
    const { walls } = this.places;
    return new Float32Array(
      walls.flatMap((_, k) => (k % 4 === 0 ? [...walls.slice(k, k + 4), 0, ...paint] : [])),
    );
  }
}
