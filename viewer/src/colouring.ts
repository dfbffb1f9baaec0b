import { categoryColour, colourAt, MapName, Rgb } from "./colours";
import { Run } from "./run";
import { quantile } from "./units";

/** A way to colour the packing: a number for each grain or particle, with one range over the whole run. */
export interface Colouring {
  key: string;
  label: string;
  /** SI; "%" where `percent`. */
  unit: string;
  on: "grain" | "particle";
  map: MapName | "categories";
  low: number;
  high: number;
  values(frame: number): Float32Array;
}

export function colourOf(colouring: Colouring, value: number): Rgb {
  const { map, low, high } = colouring;
  return map === "categories" ? categoryColour(value) : colourAt(map, (value - low) / (high - low || 1));
}

/** A hue that the colours of the grains do not have. */
export function chainColour(colouring: Colouring | null): Rgb {
  return colouring?.map === "PuOr" ? [0, 128, 106] : [230, 41, 71];
}

/** What this run has the data for. */
export function colourings(run: Run): Colouring[] {
  const found: Colouring[] = [];
  const pressure = run.has("particle.pressure") ? "particle" : "grain";
  if (run.has(`${pressure}.pressure`))
    found.push(
      ranged(run, "pressure", "pressure", "Pa", pressure, (k) => run.column(`${pressure}.pressure`, k)),
    );
  if (run.has("grain.area"))
    found.push(ranged(run, "area", "change of area", "%", "grain", (k) => areaChange(run, k)));
  if (run.has("particle.coordination"))
    found.push(counted(run, "particle", (k) => run.column("particle.coordination", k)));
  else if (run.grains > 1) found.push(counted(run, "grain", (k) => contactsOfGrains(run, k)));
  if (run.grains > 1) {
    const indices = Float32Array.from({ length: run.grains }, (_, g) => g);
    const plain = { key: "grain", label: "grain", unit: "", low: 0, high: 1 };
    found.push({ ...plain, on: "grain", map: "categories", values: () => indices });
  }
  return found;
}

/** Change of each grain's area since the start [%]. */
export function areaChange(run: Run, frame: number): Float32Array {
  const start = run.column("grain.area", 0);
  return run.column("grain.area", frame).map((area, g) => 100 * (area / start[g] - 1));
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

type Values = (frame: number) => Float32Array;

/** From 0, or symmetric about it where both signs are common; without the outermost 3 %. */
function ranged(
  run: Run,
  key: string,
  label: string,
  unit: string,
  on: "grain" | "particle",
  values: Values,
): Colouring {
  const all = run.sample(12).flatMap((k) => [...thinned(values(k))]);
  const low = Math.min(0, quantile(all, 0.03));
  const high = Math.max(0, quantile(all, 0.97));
  const common = { key, label, unit, on, values };
  const reach = Math.max(-low, high) || 1;
  if (Math.min(-low, high) > 0.1 * reach) return { ...common, map: "PuOr", low: -reach, high: reach };
  return high >= -low
    ? { ...common, map: "cividis", low: 0, high: reach }
    : { ...common, map: "cividis", low: -reach, high: 0 };
}

function counted(run: Run, on: "grain" | "particle", values: Values): Colouring {
  const most = Math.max(
    1,
    ...run.sample(12).map((k) => thinned(values(k)).reduce((m, v) => Math.max(m, v), 0)),
  );
  return { key: "contacts", label: "contacts", unit: "", on, map: "viridis", low: 0, high: most, values };
}

/** At most a few thousand of them: enough for a range. */
function thinned(values: Float32Array): Float32Array {
  const every = Math.ceil(values.length / 5000);
  return every < 2 ? values : values.filter((_, i) => i % every === 0);
}
