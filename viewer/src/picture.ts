import { Colouring, colourOf } from "./colouring";
import { Run } from "./run";
import { quantile } from "./units";

/** Where the bodies of one frame are [m], in the order of their numbers. */
export interface Places {
  grainX: Float32Array;
  grainY: Float32Array;
  outlineX: Float32Array;
  outlineY: Float32Array;
  x: Float32Array;
  y: Float32Array;
  radius: Float32Array;
  /** Of each particle; empty where there are no grains. */
  grain: Float32Array;
  /** x0 y0 x1 y1 of each wall. */
  walls: number[];
}

export function placesOf(run: Run, frame: number): Places {
  const get = (name: string) => run.column(name, frame);
  const [grainX, grainY, grain] = [get("grain.x"), get("grain.y"), get("particle.grain")];
  const [outlineX, outlineY, x, y] = [
    get("outline.x"),
    get("outline.y"),
    get("particle.x"),
    get("particle.y"),
  ];
  for (let g = 0; g + 1 < run.outlineBegin.length; ++g)
    for (let v = run.outlineBegin[g]; v < run.outlineBegin[g + 1]; ++v) {
      outlineX[v] += grainX[g];
      outlineY[v] += grainY[g];
    }
  for (let i = 0; i < grain.length; ++i) {
    x[i] += grainX[grain[i]];
    y[i] += grainY[grain[i]];
  }
  const ends = ["wall.x0", "wall.y0", "wall.x1", "wall.y1"].map(get);
  const walls = [...ends[0]].flatMap((_, w) => ends.map((end) => end[w]));
  return { grainX, grainY, outlineX, outlineY, x, y, radius: get("particle.radius"), grain, walls };
}

export interface Box {
  x0: number;
  y0: number;
  x1: number;
  y1: number;
}

/** Around everything in the whole run. */
export function boxOf(run: Run): Box {
  const box = { x0: Infinity, y0: Infinity, x1: -Infinity, y1: -Infinity };
  const add = (x: number, y: number, r: number) => {
    ((box.x0 = Math.min(box.x0, x - r)), (box.x1 = Math.max(box.x1, x + r)));
    ((box.y0 = Math.min(box.y0, y - r)), (box.y1 = Math.max(box.y1, y + r)));
  };
  for (const frame of run.sample(12)) {
    const p = placesOf(run, frame);
    p.outlineX.forEach((x, v) => add(x, p.outlineY[v], 0));
    if (!run.hasOutlines) p.x.forEach((x, i) => add(x, p.y[i], p.radius[i] ?? 0));
    for (let k = 0; k < p.walls.length; k += 2) add(p.walls[k], p.walls[k + 1], 0);
  }
  return box.x0 < box.x1 ? box : { x0: 0, y0: 0, x1: 1, y1: 1 };
}

/** How wide force chains are: `width` [m] at `force` [N/m, in space N], in proportion. */
export interface ForceScale {
  force: number;
  width: number;
}

export function forceScaleOf(run: Run): ForceScale | null {
  const forces = run.sample(25).flatMap((frame) => [...run.contacts(frame).force]);
  // what two walls do to one grain is no chain
  if (forces.length === 0 || (run.header.contacts_of_grains && run.grains < 2)) return null;
  if (run.inSpace) {
    const volume = quantile(run.column("grain.volume", 0), 0.5);
    return { force: quantile(forces, 0.99), width: 0.3 * Math.cbrt((0.75 * volume) / Math.PI) };
  }
  const last = placesOf(run, 0);
  const area = run.hasOutlines ? quantile(run.column("grain.area", 0), 0.5) : 0;
  const radius = area > 0 ? Math.sqrt(area / Math.PI) : quantile(last.radius, 0.5);
  return { force: quantile(forces, 0.99), width: (run.hasOutlines ? 0.3 : 0.9) * radius };
}

/**
 * x0 y0 x1 y1, width [m], r g b a for each contact, the stronger the less transparent; a wall is met at the foot of
 * the grain's centre.
 */
export function chainLines(
  run: Run,
  frame: number,
  p: Places,
  scale: ForceScale,
  paint: number[],
): Float32Array {
  const { a, b, force } = run.contacts(frame);
  const [x, y] = run.header.contacts_of_grains ? [p.grainX, p.grainY] : [p.x, p.y];
  const lines = new Float32Array(9 * a.length);
  a.forEach((i, c) => {
    const width = (scale.width * Math.min(force[c], 1.5 * scale.force)) / scale.force;
    const wall = b[c] - x.length;
    const end = wall < 0 ? [x[b[c]], y[b[c]]] : foot(p.walls.slice(4 * wall), x[i], y[i], width / 2);
    const strength = Math.min(0.9, Math.max(0.12, force[c] / scale.force));
    lines.set([x[i], y[i], end[0], end[1], width, ...paint, strength], 9 * c);
  });
  return lines;
}

/** The point of a wall that is nearest to (x, y), or `before` it, so that a round end does not stand out. */
function foot([x0, y0, x1, y1]: number[], x: number, y: number, before: number): [number, number] {
  const length2 = (x1 - x0) ** 2 + (y1 - y0) ** 2 || 1;
  const s = Math.min(1, Math.max(0, ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / length2));
  const [fx, fy] = [x0 + s * (x1 - x0), y0 + s * (y1 - y0)];
  const back = before / (Math.hypot(x - fx, y - fy) || 1);
  return [fx + back * (x - fx), fy + back * (y - fy)];
}

/** The colour of each grain, 0 to 1. Where points show the quantity, of the mean beneath them. */
export function grainColours(run: Run, frame: number, colouring: Colouring): Float32Array {
  const onPoints = colouring.on === "particle";
  const values = onPoints ? run.column(`grain.${colouring.key}`, frame) : colouring.values(frame);
  return colours(values, run.grains, colouring);
}

/** The colour of each particle, 0 to 1. */
export function particleColours(frame: number, colouring: Colouring, p: Places): Float32Array {
  const values = colouring.values(frame);
  const ofGrain = colouring.on === "grain";
  return colours(ofGrain ? p.grain.map((g) => values[g]) : values, p.x.length, colouring);
}

function colours(values: Float32Array, count: number, colouring: Colouring): Float32Array {
  const rgb = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i)
    rgb.set(
      colourOf(colouring, values[i]).map((c) => c / 255),
      3 * i,
    );
  return rgb;
}
