import { categoryColour, colourAt, MapName, Rgb } from "./colours";
import { Run } from "./run";
import { quantile } from "./units";

/** A way to colour the packing: a number for each grain or particle, with one range over the whole run. */
export interface Colouring {
  key: string;
  label: string;
  /** SI; "%" where `percent`. */
  unit: string;
  on: "grain" | "particle" | "vertex";
  map: MapName | "categories";
  low: number;
  high: number;
  /** Whether colours run over powers of ten: then low > 0. */
  log?: boolean;
  values(frame: number): Float32Array;
}

/** Which values the colours range over: of the whole run, of the picture, or to the very ends. */
export type RangeOver = "run" | "picture" | "ends";

const LOG_RANGE = 1000;

export function colourOf(colouring: Colouring, value: number): Rgb {
  const { map } = colouring;
  return map === "categories" ? categoryColour(value) : colourAt(map, shareOf(colouring, value));
}

/** Where a value lies between the ends: 0 at the lower, 1 at the upper. */
export function shareOf({ low, high, log }: Colouring, value: number): number {
  return log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low || 1);
}

/** What stands in the middle of the scale. */
export const middleOf = ({ low, high, log }: Colouring): number =>
  log ? Math.sqrt(low * high) : 0.5 * (low + high);

/** A hue that the colours of the grains do not have. */
export function chainColour(colouring: Colouring | null): Rgb {
  return colouring?.map === "PuOr" ? [0, 128, 106] : [230, 41, 71];
}

/** What this run has the data for. */
export function colourings(run: Run): Colouring[] {
  const found: Colouring[] = [];
  for (const { name, label, unit } of run.header.fields) {
    const on = (["particle", "vertex", "grain"] as const).find((owner) => run.has(`${owner}.${name}`));
    const values = (frame: number) => run.column(`${on}.${name}`, frame);
    if (on) found.push(withMap(run, { key: name, label, unit, on, values }));
  }
  for (const size of ["area", "volume"] as const)
    if (run.has(`grain.${size}`))
      found.push(
        withMap(run, {
          key: size,
          label: `change of ${size}`,
          unit: "%",
          on: "grain",
          values: (frame) => sizeChange(run, size, frame),
        }),
      );
  if (run.has("grain.kind")) {
    const values = (frame: number) => run.column("grain.kind", frame);
    found.push(withMap(run, { key: "kind", label: "kind", unit: "", on: "grain", values }));
  }
  if (run.grains > 1) {
    if (!run.has("particle.coordination"))
      found.push(
        withMap(run, {
          key: "contacts",
          label: "contacts",
          unit: "",
          on: "grain",
          values: (frame) => contactsOfGrains(run, frame),
        }),
      );
    const indices = Float32Array.from({ length: run.grains }, (_, g) => g);
    const plain = { key: "grain", label: "grain", unit: "", low: 0, high: 1 };
    found.push({ ...plain, on: "grain", map: "categories", values: () => indices });
  }
  return found;
}

/** Change of each grain's area, or volume, since the start [%]. */
export function sizeChange(run: Run, size: "area" | "volume", frame: number): Float32Array {
  const start = run.column(`grain.${size}`, 0);
  return run.column(`grain.${size}`, frame).map((now, g) => 100 * (now / start[g] - 1));
}

/** Number of other grains, and walls, that push each grain. */
export function contactsOfGrains(run: Run, frame: number): Float32Array {
  const neighbours = Array.from({ length: run.grains }, () => new Set<number>());
  const { a, b } = run.contacts(frame);
  const owner = run.header.contacts_of_grains ? null : run.column("particle.grain", frame);
  a.forEach((first, c) => {
    const i = owner ? owner[first] : first;
    const wall = owner ? b[c] - owner.length : -1;
    const j = !owner ? b[c] : wall < 0 ? owner[b[c]] : run.grains + wall;
    if (i === j) return;
    neighbours[i]?.add(j);
    neighbours[j]?.add(i);
  });
  return Float32Array.from(neighbours, (set) => set.size);
}

type Unranged = Pick<Colouring, "key" | "label" | "unit" | "on" | "values">;

/** Before contacts carry forces, attraction alone makes pressures that would set the range. */
function framesForRange(run: Run): number[] {
  const frames = run.sample(12);
  const pushed = frames.filter((frame) => run.contacts(frame).force.length > 0);
  return pushed.length > 0 ? pushed : frames;
}

/** Whole numbers are counted; of others the outermost 1 % are left out. */
function withMap(run: Run, plain: Unranged): Colouring {
  const all = framesForRange(run).flatMap((frame) => [...thinned(plain.values(frame))]);
  if (all.length > 0 && all.every((value) => value >= 0 && Number.isInteger(value))) {
    const most = all.reduce((m, v) => Math.max(m, v), 1);
    return { ...plain, map: "viridis", low: 0, high: most };
  }
  return { ...plain, ...rangeOf(all, 0.01) };
}

/** From 0, or symmetric about it where both signs are common; or between its ends where they are close together. */
function rangeOf(all: number[], outermost: number): Pick<Colouring, "map" | "low" | "high"> {
  const [least, most] = [quantile(all, outermost), quantile(all, 1 - outermost)];
  if (least > 0.8 * most && most > least) return { map: "viridis", low: least, high: most };
  const [low, high] = [Math.min(0, least), Math.max(0, most)];
  const reach = Math.max(-low, high) || 1;
  if (Math.min(-low, high) > 0.1 * reach) return { map: "PuOr", low: -reach, high: reach };
  return high >= -low ? { map: "cividis", low: 0, high: reach } : { map: "cividis", low: -reach, high: 0 };
}

/** The same with the range that the reader wants: over other values, or between numbers of his own. */
export function reranged(
  run: Run,
  colouring: Colouring,
  over: RangeOver,
  frame: number,
  own: { low?: number; high?: number },
  log = false,
): Colouring {
  if (colouring.map === "categories") return colouring;
  const counted = colouring.map === "viridis" && colouring.low === 0;
  let ranged = colouring;
  if (over === "picture")
    ranged = { ...colouring, ...rangeOf([...colouring.values(frame)], counted ? 0 : 0.01) };
  if (over === "ends") {
    const all = framesForRange(run).flatMap((k) => [...colouring.values(k)]);
    ranged = { ...colouring, ...rangeOf(all, 0) };
  }
  ranged = { ...ranged, low: own.low ?? ranged.low, high: own.high ?? ranged.high };
  return log ? logarithmic(ranged) : ranged;
}

/** Over powers of ten: as many as the range has, at most LOG_RANGE; what lies below has the lowest colour. */
function logarithmic(colouring: Colouring): Colouring {
  const { low, high, map } = colouring;
  if (high <= 0 || map === "categories") return colouring; // there is none
  const positive = low > 0 && low < high ? low : high / LOG_RANGE;
  return { ...colouring, low: positive, log: true, map: map === "PuOr" ? "cividis" : map };
}

/** At most a few thousand of them: enough for a range. */
function thinned(values: Float32Array): Float32Array {
  const every = Math.ceil(values.length / 5000);
  return every < 2 ? values : values.filter((_, i) => i % every === 0);
}
