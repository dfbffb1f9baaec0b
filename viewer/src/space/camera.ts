// From where one looks: parallel, as `softgrain plot` draws.

export type Vec3 = [number, number, number];

export const dot = (a: Vec3, b: Vec3): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const plus = (a: Vec3, b: Vec3, s = 1): Vec3 => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
export const minus = (a: Vec3, b: Vec3): Vec3 => plus(a, b, -1);
export const cross = (a: Vec3, b: Vec3): Vec3 => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

const DEGREE = Math.PI / 180;
const START = { azimuth: -62, elevation: 18, zoom: 1 };

export class Camera {
  /** [degrees] */
  azimuth = START.azimuth;
  elevation = START.elevation;
  zoom = START.zoom;
  /** What is in the middle of the picture [m]. */
  centre: Vec3 = [0, 0, 0];
  /** Of what is looked at: its middle and half of its diagonal [m]. */
  private middle: Vec3 = [0, 0, 0];
  reach = 1;

  lookAt(low: Vec3, high: Vec3): void {
    this.middle = low.map((l, k) => (l + high[k]) / 2) as Vec3;
    this.reach = Math.hypot(...minus(high, low)) / 2 || 1;
    this.centre = this.middle;
  }

  reset(): void {
    Object.assign(this, START, { centre: this.middle });
  }

  get right(): Vec3 {
    const a = this.azimuth * DEGREE;
    return [-Math.sin(a), Math.cos(a), 0];
  }
  get towards(): Vec3 {
    const [a, e] = [this.azimuth * DEGREE, this.elevation * DEGREE];
    return [Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e)];
  }
  get up(): Vec3 {
    return cross(this.towards, this.right);
  }

  turn(azimuth: number, elevation: number): void {
    this.azimuth = ((((this.azimuth + azimuth + 180) % 360) + 360) % 360) - 180;
    this.elevation = Math.min(90, Math.max(-90, this.elevation + elevation));
  }

  /** Magnifies about a place of the picture, right and up of its middle [m]. */
  zoomAt(factor: number, [right, up]: [number, number]): void {
    const zoom = Math.min(64, Math.max(0.5, this.zoom * factor));
    const moved = 1 - this.zoom / zoom;
    this.zoom = zoom;
    this.pan(-right * moved, -up * moved);
  }

  /** Moves what is seen [m]. */
  pan(right: number, up: number): void {
    this.centre = plus(plus(this.centre, this.right, -right), this.up, -up);
  }

  /** "-62,18,1" with the centre behind it where it was moved, for the address. */
  get text(): string {
    const place =
      this.centre === this.middle ? [] : minus(this.centre, this.middle).map((d) => d / this.reach);
    return [this.azimuth, this.elevation, this.zoom, ...place].map((x) => Number(x.toFixed(3))).join();
  }
  set text(words: string) {
    const numbers = words.split(",").map(Number);
    if (numbers.length < 3 || !numbers.every(Number.isFinite)) return;
    this.reset();
    [this.azimuth, this.elevation, this.zoom] = numbers;
    this.turn(0, 0);
    this.zoom = Math.min(64, Math.max(0.5, this.zoom));
    if (numbers.length === 6) this.centre = plus(this.middle, numbers.slice(3) as Vec3, this.reach);
  }
}
