// Numbers with units, as people write them.

const PREFIXES: [number, string][] = [
  [1e9, "G"],
  [1e6, "M"],
  [1e3, "k"],
  [1, ""],
  [1e-3, "m"],
  [1e-6, "µ"],
  [1e-9, "n"],
];
const PREFIXED = ["Pa", "m", "s", "m/s", "N", "N/m", "J", "J/m"];

/** value [shown unit] = factor * value [SI]. */
export interface Scale {
  factor: number;
  unit: string;
}

/** The unit in which `largest` has one to three digits before the point. */
export function scaleFor(largest: number, unit: string): Scale {
  const size = Math.abs(largest);
  if (!PREFIXED.includes(unit) || !(size > 0)) return { factor: 1, unit };
  const [power, prefix] = PREFIXES.find(([p]) => size >= p) ?? PREFIXES[PREFIXES.length - 1];
  return { factor: 1 / power, unit: prefix + unit };
}

/** Three digits, no needless zeros. */
export function short(value: number): string {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const text = Number(value.toPrecision(3));
  return (Math.abs(text) >= 1e5 || Math.abs(text) < 1e-3 ? text.toExponential() : String(text)).replace(
    "-",
    "−",
  );
}

export function withUnit(value: number, unit: string): string {
  const scale = scaleFor(value, unit);
  return `${short(scale.factor * value)}${scale.unit ? " " + scale.unit : ""}`;
}

export function duration(seconds: number): string {
  if (seconds < 60) return `${short(seconds)} s`;
  const minutes = Math.round(seconds / 60);
  return minutes < 60 ? `${minutes} min` : `${Math.floor(minutes / 60)} h ${minutes % 60} min`;
}

const SYMBOLS: Record<string, string> = {
  strain: "strain ε",
  phi: "packing fraction Φ",
  z: "coordination number Z",
  phi_0: "packing fraction Φ₀, areas at the start",
  stress_top: "stress, top",
  stress_bottom: "stress, bottom",
  stress_side: "stress, side",
  area_ratio: "area A / A₀",
  least_J: "least det F",
};

/** "stress, top" for stress_top. */
export function label(column: string): string {
  return SYMBOLS[column] ?? column.replaceAll("_", " ");
}

/** What fraction `share` of the values lies below. */
export function quantile(values: number[] | Float32Array, share: number): number {
  const sorted = Float32Array.from(values).filter(Number.isFinite).sort();
  return sorted.length === 0 ? 0 : sorted[Math.floor(share * (sorted.length - 1))];
}
