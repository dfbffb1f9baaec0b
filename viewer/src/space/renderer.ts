import { chainColour } from "../colouring";
import { Buffer, Mesh, Program } from "../gl";
import { ForceScale, forceScaleOf } from "../picture";
import { Drawing, inkOf, Look } from "../drawing";
import { Run } from "../run";
import { quantile } from "../units";
import { Camera, dot, minus, plus, Vec3 } from "./camera";
import * as shaders from "./shaders";
import { boxInSpace, chainsInSpace, Net, netOf, Surfaces, surfacesOf, vertexColours } from "./surfaces";

/** Where the packing is cut: across x, y or z at a share of its size; "" for nowhere. */
export interface Cut {
  axis: "" | "x" | "y" | "z";
  share: number;
}

const LIGHT: Vec3 = [0.285, -0.611, 0.651]; // to it; as softgrain plot has it, at the first view
const MARGIN = 14; // [CSS pixels]
/** Pixels for one of CSS: twice as many as are shown make edges smooth. */
const RATIO = 2;

/** Draws the grains of a run in three dimensions on a canvas. */
export class SpaceRenderer implements Drawing {
  readonly camera = new Camera();
  cut: Cut = { axis: "", share: 0.5 };
  forceScale: ForceScale | null = null;
  run!: Run;
  private net!: Net;
  private surfaces!: Surfaces;
  private shown = -1;
  /** Of a grain in the middle [m]. */
  private radius = 1;
  private low: Vec3 = [0, 0, 0];
  private high: Vec3 = [1, 1, 1];
  private gl: WebGL2RenderingContext;
  private surface: Program;
  private line: Program;
  private mesh: Mesh;
  private lines: Buffer;

  /** Throws where the browser has no WebGL2. */
  constructor(private canvas: HTMLCanvasElement) {
    const gl = canvas.getContext("webgl2", { antialias: false });
    if (!gl) throw new Error("no WebGL2");
    this.gl = gl;
    this.surface = new Program(gl, shaders.SURFACE_VERTEX, shaders.SURFACE_FRAGMENT);
    this.line = new Program(gl, shaders.LINE_VERTEX, shaders.LINE_FRAGMENT);
    this.mesh = new Mesh(gl, [3, 3, 1, 3]);
    this.lines = new Buffer(gl, [3, 3, 1, 4], true);
  }

  show(run: Run): void {
    this.run = run;
    this.net = netOf(run);
    [this.low, this.high] = boxInSpace(run, this.net);
    this.forceScale = forceScaleOf(run);
    this.radius = Math.cbrt((0.75 * quantile(run.column("grain.volume", 0), 0.5)) / Math.PI);
    this.camera.lookAt(this.low, this.high);
    this.camera.reset();
    this.shown = -1;
    this.mesh.index(this.net.triangles);
    this.mesh.fill(2, this.net.grain);
  }

  /** Of the picture from the first view, which is about as wide as high. */
  get aspect(): number {
    return 1.25;
  }

  /** CSS pixels per metre. */
  get pixelsPerMetre(): number {
    const size = Math.min(this.canvas.clientWidth, this.canvas.clientHeight) - MARGIN;
    return (this.camera.zoom * size) / (2 * this.camera.reach * 0.86); // most boxes stay within, from everywhere
  }

  /** Right and up of the middle of the picture [m], of a place on the canvas [CSS pixels]. */
  toPicture(px: number, py: number): [number, number] {
    const s = this.pixelsPerMetre;
    return [(px - this.canvas.clientWidth / 2) / s, (this.canvas.clientHeight / 2 - py) / s];
  }

  draw(frame: number, look: Look, ratio = RATIO * Math.min(1.5, window.devicePixelRatio || 1)): void {
    const { gl, canvas, run } = this;
    const [width, height] = [Math.round(canvas.clientWidth * ratio), Math.round(canvas.clientHeight * ratio)];
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clearDepth(1);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.take(frame);
    const chains = look.chains && this.forceScale;
    if (!chains) this.drawSurfaces(frame, look, false);
    this.drawLines(this.edges([...inkOf(canvas), 0.6]), 1.3, 0);
    if (chains) {
      const paint = chainColour(look.colouring).map((c) => c / 255);
      this.drawLines(chainsInSpace(run, frame, this.surfaces, this.forceScale!, paint), 0.8, 1);
      gl.depthMask(false);
      this.drawSurfaces(frame, look, true);
      gl.depthMask(true);
    }
    gl.disable(gl.DEPTH_TEST);
  }

  /** The nearest grain under a place of the picture that is not cut off; -1 for none. */
  pick(px: number, py: number): number {
    const { camera, net, surfaces } = this;
    const { right, up, towards } = camera;
    const [wantedX, wantedY] = this.toPicture(px, py);
    const [normal, place] = this.cutPlane;
    const at = (v: number) => {
      const x = [...surfaces.vertex.subarray(3 * v, 3 * v + 3)] as Vec3;
      const d = minus(x, camera.centre);
      return [dot(d, right) - wantedX, dot(d, up) - wantedY, dot(d, towards), dot(normal, x) - place];
    };
    let [nearest, found] = [-Infinity, -1];
    for (let g = 0; g < this.run.grains; ++g) {
      if (!this.mayHit(g, wantedX, wantedY)) continue;
      for (let t = net.begin[g]; t < net.begin[g + 1]; ++t) {
        const [a, b, c] = [0, 1, 2].map((k) => at(net.triangles[3 * t + k]));
        const [u, v, w] = [b[0] * c[1] - c[0] * b[1], c[0] * a[1] - a[0] * c[1], a[0] * b[1] - b[0] * a[1]];
        const sum = u + v + w;
        if (sum === 0 || u / sum < 0 || v / sum < 0 || w / sum < 0) continue;
        const mean = (k: number) => (u * a[k] + v * b[k] + w * c[k]) / sum;
        if (mean(3) > 0 || mean(2) <= nearest) continue;
        [nearest, found] = [mean(2), g];
      }
    }
    return found;
  }

  centreOf(grain: number): Vec3 {
    return [...this.surfaces.centre.subarray(3 * grain, 3 * grain + 3)] as Vec3;
  }

  /** Could a grain lie under that place? By twice the radius of a sphere of its volume. */
  private mayHit(grain: number, right: number, up: number): boolean {
    const d = minus(this.centreOf(grain), this.camera.centre);
    const [x, y] = [dot(d, this.camera.right) - right, dot(d, this.camera.up) - up];
    const volume = this.run.column("grain.volume", this.shown)[grain];
    return Math.hypot(x, y) < 2 * Math.cbrt((0.75 * volume) / Math.PI);
  }

  private take(frame: number): void {
    if (frame === this.shown) return;
    this.shown = frame;
    this.surfaces = surfacesOf(this.run, this.net, frame);
    this.mesh.fill(0, this.surfaces.vertex);
    this.mesh.fill(1, this.surfaces.normal);
  }

  /** Normal and place of the plane beyond which all is left out: on the side that looks at us. */
  private get cutPlane(): [Vec3, number] {
    const k = ["x", "y", "z"].indexOf(this.cut.axis);
    if (k < 0) return [[0, 0, 0], 1];
    const side = this.camera.towards[k] < 0 ? -1 : 1;
    const normal: Vec3 = [0, 0, 0];
    normal[k] = side;
    return [normal, side * (this.low[k] + this.cut.share * (this.high[k] - this.low[k]))];
  }

  private use(program: Program): void {
    const { gl, canvas, camera } = this;
    gl.useProgram(program.handle);
    const s = this.pixelsPerMetre;
    program.set("centre", ...camera.centre);
    program.set("right", ...camera.right);
    program.set("up", ...camera.up);
    program.set("towards", ...camera.towards);
    program.set("scale", (2 * s) / canvas.clientWidth, (2 * s) / canvas.clientHeight);
    program.set("depth", 1 / (3 * camera.reach));
    const [normal, place] = this.cutPlane;
    program.set("cut_normal", ...normal);
    program.set("cut_place", place);
  }

  private drawSurfaces(frame: number, look: Look, glass: boolean): void {
    this.mesh.fill(3, vertexColours(this.run, this.net, frame, look.colouring));
    this.use(this.surface);
    this.surface.set("light", ...this.light);
    this.surface.set("highlight", look.highlight);
    this.surface.set("glass", glass ? 1 : 0);
    this.surface.set("before", this.cut.axis === "" ? 0 : 0.15 * this.radius);
    this.mesh.draw();
  }

  /** It turns with us, so that what we look at is never dark. */
  private get light(): Vec3 {
    const first = new Camera();
    const share = [first.right, first.up, first.towards].map((d) => dot(d, LIGHT));
    const { right, up, towards } = this.camera;
    return plus(plus(plus([0, 0, 0], right, share[0]), up, share[1]), towards, share[2]);
  }

  private drawLines(lines: Float32Array, thinnest: number, round: number): void {
    if (lines.length === 0) return;
    const { gl, canvas } = this;
    const ratio = canvas.width / canvas.clientWidth;
    this.use(this.line);
    this.line.set("pixels", this.pixelsPerMetre * ratio);
    this.line.set("thinnest", thinnest * ratio);
    this.line.set("round_", round);
    this.lines.fill(lines);
    this.lines.bind();
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, lines.length / 11);
  }

  /** Of the faces of the box, or of the two walls. */
  private edges(paint: number[]): Float32Array {
    return new Float32Array(
      this.surfaces.walls.flatMap((wall) =>
        wall.flatMap((corner, k) => [...corner, ...wall[(k + 1) % 4], 0, ...paint]),
      ),
    );
  }
}
