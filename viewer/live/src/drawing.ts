import { colourAt, css } from "../../src/colours";
import { quantile } from "../../src/units";
import { Picture } from "./messages";

/** Space around the box [CSS pixels]; the top wall is as thick. */
const MARGIN = 18;
const CHAIN = "230, 41, 71";
/** A pressure and a force that are small for grains of the page [Pa], [N/m]. */
const SMALL_PRESSURE = 5e4;
const SMALL_FORCE = 20;

/** Draws grains, walls and force chains on a canvas. */
export class Drawing {
  /** The largest pressure that has a colour of its own: what was reached [Pa]. */
  pressure = SMALL_PRESSURE;
  private force = SMALL_FORCE;
  private scale = 1; // CSS pixels per metre
  private left = 0;
  private floor = 0;
  private pen: CanvasRenderingContext2D;

  constructor(private canvas: HTMLCanvasElement) {
    // painted by the processor: where the graphics are emulated, a thousand circles held the page up for seconds
    this.pen = canvas.getContext("2d", { willReadFrequently: true })!;
  }

  reset(): void {
    this.pressure = SMALL_PRESSURE;
    this.force = SMALL_FORCE;
  }

  /** Place of a height in the box [CSS pixels from the top of the canvas], and back. */
  toPixels(height: number): number {
    return this.floor - this.scale * height;
  }
  toHeight(pixels: number): number {
    return (this.floor - pixels) / this.scale;
  }
  /** Left end and width of the box [CSS pixels]. */
  get sides(): [number, number] {
    return [this.left, this.canvas.clientWidth - 2 * this.left];
  }

  draw(picture: Picture, startHeight: number, goal: number, chains: boolean): void {
    const { pen } = this;
    const { width, height } = picture.numbers;
    this.place(width, startHeight);
    const style = getComputedStyle(this.canvas);
    const ink = style.color;
    this.pressure = Math.max(this.pressure, quantile(picture.pressure, 0.95));
    const colours = [...picture.pressure].map((p) => css(colourAt("cividis", p / this.pressure)));
    pen.save();
    pen.transform(this.scale, 0, 0, -this.scale, this.left, this.floor);
    pen.lineJoin = pen.lineCap = "round";
    pen.strokeStyle = ink;
    pen.lineWidth = 1.2 / this.scale;
    if (picture.disks.length > 0) this.drawDisks(picture.disks, colours);
    else this.drawOutlines(picture, colours);
    if (chains) {
      pen.beginPath();
      pen.rect(0, 0, width, height);
      pen.clip();
      this.drawChains(picture.chains);
    }
    pen.restore();
    this.drawWalls(width, height, goal, ink);
  }

  private place(width: number, startHeight: number): void {
    const { canvas, pen } = this;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    const [w, h] = [canvas.clientWidth, canvas.clientHeight];
    const size = [Math.round(w * ratio), Math.round(h * ratio)];
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, w, h);
    this.scale = Math.min((w - 2 * MARGIN) / width, (h - 3 * MARGIN) / startHeight);
    this.left = (w - this.scale * width) / 2;
    this.floor = h - MARGIN;
  }

  private drawOutlines({ outline, outlineBegin }: Picture, colours: string[]): void {
    for (let g = 0; g + 1 < outlineBegin.length; ++g) {
      this.pen.fillStyle = colours[g];
      this.pen.fill(smooth(outline, outlineBegin[g], outlineBegin[g + 1]));
    }
    this.pen.globalAlpha = 0.7;
    for (let g = 0; g + 1 < outlineBegin.length; ++g)
      this.pen.stroke(smooth(outline, outlineBegin[g], outlineBegin[g + 1]));
    this.pen.globalAlpha = 1;
  }

  /** A little smaller than they are, so that they can be told apart without lines; one by one, as circles are fastest. */
  private drawDisks(disks: Float32Array, colours: string[]): void {
    for (let k = 0; k < disks.length; k += 4) {
      const [x, y, r, grain] = disks.subarray(k, k + 4);
      this.pen.fillStyle = colours[grain];
      this.pen.beginPath();
      this.pen.arc(x, y, 0.94 * r, 0, 2 * Math.PI);
      this.pen.fill();
    }
  }

  /** The stronger the wider and the less transparent. */
  private drawChains(chains: Float32Array): void {
    const { pen } = this;
    const forces = chains.filter((_, k) => k % 5 === 4);
    this.force += 0.2 * (Math.max(SMALL_FORCE, quantile(forces, 0.97)) - this.force);
    const widest = 7 / this.scale;
    for (let k = 0; k < chains.length; k += 5) {
      const [x0, y0, x1, y1, force] = chains.subarray(k, k + 5);
      const share = Math.min(1.3, force / this.force);
      if (share < 0.02) continue;
      pen.strokeStyle = `rgba(${CHAIN}, ${Math.min(0.9, 0.15 + share)})`;
      pen.lineWidth = Math.max(0.8 / this.scale, widest * share);
      pen.beginPath();
      pen.moveTo(x0, y0);
      pen.lineTo(x1, y1);
      pen.stroke();
    }
  }

  private drawWalls(width: number, height: number, goal: number, ink: string): void {
    const { pen, left, floor } = this;
    const [top, right] = [this.toPixels(height), left + this.scale * width];
    pen.strokeStyle = pen.fillStyle = ink;
    pen.lineWidth = 3;
    pen.lineJoin = "round";
    pen.beginPath();
    pen.moveTo(left - 1.5, MARGIN);
    pen.lineTo(left - 1.5, floor + 1.5);
    pen.lineTo(right + 1.5, floor + 1.5);
    pen.lineTo(right + 1.5, MARGIN);
    pen.stroke();
    pen.fillRect(left, top - 5, right - left, 5);
    const wanted = this.toPixels(goal);
    if (Math.abs(wanted - top) < 2) return;
    pen.setLineDash([5, 5]);
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.moveTo(left, wanted);
    pen.lineTo(right, wanted);
    pen.stroke();
    pen.setLineDash([]);
  }
}

/** A closed curve through the vertices begin .. end - 1: Catmull and Rom's, as Bezier curves. */
function smooth(xy: Float32Array, begin: number, end: number): Path2D {
  const path = new Path2D();
  const count = end - begin;
  const at = (k: number) => 2 * (begin + ((k + count) % count));
  path.moveTo(xy[at(0)], xy[at(0) + 1]);
  for (let k = 0; k < count; ++k) {
    const [a, b, c, d] = [at(k - 1), at(k), at(k + 1), at(k + 2)];
    path.bezierCurveTo(
      xy[b] + (xy[c] - xy[a]) / 6,
      xy[b + 1] + (xy[c + 1] - xy[a + 1]) / 6,
      xy[c] - (xy[d] - xy[b]) / 6,
      xy[c + 1] - (xy[d + 1] - xy[b + 1]) / 6,
      xy[c],
      xy[c + 1],
    );
  }
  path.closePath();
  return path;
}
