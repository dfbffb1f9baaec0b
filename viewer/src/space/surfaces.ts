import { colourAt, categoryColour } from "../colours";
import { Colouring, shareOf } from "../colouring";
import { ForceScale } from "../picture";
import { Run } from "../run";
import { Vec3 } from "./camera";

/** What does not change in a run. */
export interface Net {
  /** Three vertices of each triangle, counter-clockwise seen from outside; two of each quad. */
  triangles: Uint32Array;
  /** Of each vertex. */
  grain: Float32Array;
  /** Grain g has the triangles begin[g] .. begin[g + 1] - 1. */
  begin: number[];
}

export function netOf(run: Run): Net {
  const corner = [0, 1, 2, 3].map((k) => run.column(`quad.${k}`, 0));
  const grain = run.column("vertex.grain", 0);
  const quads = corner[0].length;
  const triangles = new Uint32Array(6 * quads);
  const begin = [0];
  for (let q = 0; q < quads; ++q) {
    const [a, b, c, d] = corner.map((column) => column[q]);
    triangles.set([a, b, c, a, c, d], 6 * q);
    while (begin.length <= grain[a]) begin.push(2 * q);
  }
  while (begin.length <= run.grains) begin.push(2 * quads);
  return { triangles, grain, begin };
}

/** One frame [m]. */
export interface Surfaces {
  /** x y z of each vertex: its grain's centre, the grain's motion as a whole, and what is left. */
  vertex: Float32Array;
  /** Of each vertex, the mean of the triangles round it by their areas; not of length 1. */
  normal: Float32Array;
  /** x y z of each grain. */
  centre: Float32Array;
  /** Four corners of each wall. */
  walls: Vec3[][];
}

export function surfacesOf(run: Run, net: Net, frame: number): Surfaces {
  const columns = (names: string[]) => names.map((name) => run.column(name, frame));
  const [gx, gy, gz] = columns(["grain.x", "grain.y", "grain.z"]);
  const A = columns(["00", "01", "02", "10", "11", "12", "20", "21", "22"].map((ij) => `grain.a${ij}`));
  const [X, Y, Z] = columns(["rest.x", "rest.y", "rest.z"]);
  const left = columns(["vertex.x", "vertex.y", "vertex.z"]);
  const centre = new Float32Array(3 * gx.length).map((_, i) => [gx, gy, gz][i % 3][Math.floor(i / 3)]);
  const vertex = new Float32Array(3 * net.grain.length);
  for (let v = 0; v < net.grain.length; ++v) {
    const g = net.grain[v];
    for (let i = 0; i < 3; ++i)
      vertex[3 * v + i] =
        centre[3 * g + i] +
        A[3 * i][g] * X[v] +
        A[3 * i + 1][g] * Y[v] +
        A[3 * i + 2][g] * Z[v] +
        (left[i].length > 0 ? left[i][v] : 0);
  }
  const wall = columns(Array.from({ length: 12 }, (_, k) => `wall.${k}`));
  const walls = [...wall[0]].map((_, w) =>
    [0, 1, 2, 3].map((c) => [0, 1, 2].map((d) => wall[3 * c + d][w]) as Vec3),
  );
  return { vertex, normal: normalsOf(vertex, net.triangles), centre, walls };
}

function normalsOf(x: Float32Array, triangles: Uint32Array): Float32Array {
  const normal = new Float32Array(x.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const [ux, uy, uz] = [x[b] - x[a], x[b + 1] - x[a + 1], x[b + 2] - x[a + 2]];
    const [wx, wy, wz] = [x[c] - x[a], x[c + 1] - x[a + 1], x[c + 2] - x[a + 2]];
    const [nx, ny, nz] = [uy * wz - uz * wy, uz * wx - ux * wz, ux * wy - uy * wx];
    for (const v of [a, b, c]) {
      normal[v] += nx;
      normal[v + 1] += ny;
      normal[v + 2] += nz;
    }
  }
  return normal;
}

/** Least and largest coordinates of everything in the whole run [m]. */
export function boxInSpace(run: Run, net: Net): [Vec3, Vec3] {
  const low: Vec3 = [Infinity, Infinity, Infinity];
  const high: Vec3 = [-Infinity, -Infinity, -Infinity];
  const add = (x: ArrayLike<number>, at: number) => {
    for (let d = 0; d < 3; ++d) {
      low[d] = Math.min(low[d], x[at + d]);
      high[d] = Math.max(high[d], x[at + d]);
    }
  };
  for (const frame of run.sample(4)) {
    const { vertex, walls } = surfacesOf(run, net, frame);
    for (let v = 0; v < vertex.length; v += 3) add(vertex, v);
    walls.flat().forEach((corner) => add(corner, 0));
  }
  return [low, high];
}

const SHADES = 512;

/** r g b of each vertex, 0 to 1. */
export function vertexColours(run: Run, net: Net, frame: number, colouring: Colouring | null): Float32Array {
  const count = net.grain.length;
  if (!colouring) return new Float32Array(3 * count).fill(0.6);
  const values = colouring.values(frame);
  const ofVertex = colouring.on === "vertex";
  const shades: number[][] = [];
  const { map } = colouring;
  if (map === "categories") for (let g = 0; g < run.grains; ++g) shades.push(categoryColour(g));
  else for (let k = 0; k <= SHADES; ++k) shades.push(colourAt(map, k / SHADES));
  const rgb = new Float32Array(3 * count);
  for (let v = 0; v < count; ++v) {
    const value = values[ofVertex ? v : net.grain[v]];
    const place = map === "categories" ? value : Math.round(SHADES * shareOf(colouring, value));
    const shade = shades[Math.min(shades.length - 1, Math.max(0, place || 0))];
    for (let c = 0; c < 3; ++c) rgb[3 * v + c] = shade[c] / 255;
  }
  return rgb;
}

/** Both ends, width [m] and r g b a of each contact: from centre to centre, or to the foot on a wall. */
export function chainsInSpace(
  run: Run,
  frame: number,
  { centre, walls }: Surfaces,
  scale: ForceScale,
  paint: number[],
): Float32Array {
  const { a, b, force } = run.contacts(frame);
  const at = (g: number) => [...centre.subarray(3 * g, 3 * g + 3)] as Vec3;
  const lines = new Float32Array(11 * a.length);
  a.forEach((i, c) => {
    const width = (scale.width * Math.min(force[c], 1.5 * scale.force)) / scale.force;
    const begin = at(i);
    const wall = walls[b[c] - run.grains];
    const end = wall ? footOn(wall, begin) : at(b[c]);
    lines.set([...begin, ...end, width, ...paint, 1], 11 * c);
  });
  return lines;
}

/** The walls are along the axes: the coordinate in which a wall's corners agree. */
function footOn(wall: Vec3[], x: Vec3): Vec3 {
  const foot = [...x] as Vec3;
  const size = [0, 1, 2].map((d) => Math.max(...wall.map((c) => c[d])) - Math.min(...wall.map((c) => c[d])));
  const axis = size.indexOf(Math.min(...size));
  foot[axis] = wall[0][axis];
  return foot;
}
