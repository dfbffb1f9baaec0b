// What a visitor chooses, and the case file that says it.

export type Model = "elastic" | "plastic" | "bonded";

export interface Choices {
  model: Model;
  law: string;
  grains: number;
  friction: number;
  poisson: number;
  /** Of the top wall [m/s]. */
  speed: number;
  seed: number;
}

export const DEFAULTS: Choices = {
  model: "elastic",
  law: "neo_hookean",
  grains: 30,
  friction: 0.3,
  poisson: 0.45,
  speed: 0.1,
  seed: 1,
};

/** Laws of elastic grains: name in a case file, name for people. */
export const LAWS: [string, string][] = [
  ["neo_hookean", "neo-Hookean"],
  ["hencky", "Hencky"],
  ["corotated", "corotated"],
  ["mooney_rivlin", "Mooney-Rivlin"],
];

/** Least and largest of each number. */
export const RANGES: Record<"grains" | "friction" | "poisson" | "seed", [number, number]> = {
  grains: [1, 60],
  friction: [0, 1],
  poisson: [0, 0.49],
  seed: [1, 999999],
};

/** Of wall speeds [m/s]: bonds ask for short steps, and a slow wall for very many of them. */
export const SPEEDS: Record<Model, [number, number]> = {
  elastic: [0.01, 5],
  plastic: [0.01, 5],
  bonded: [2, 10],
};

/** Packing fraction at the start: few grains find no places in a dense box. At the end, by areas at the start. */
const firstFraction = (c: Choices): number => (c.grains < 10 ? 0.5 : 0.7);
const LAST_FRACTION = 1.09;
const lastStrain = (c: Choices): number => Number(Math.log(LAST_FRACTION / firstFraction(c)).toFixed(3));

/** The way of the top wall in a step [m]: of soft grains 0.016 of a mean radius. */
const WAY = { elastic: 15e-6, plastic: 15e-6, bonded: 1e-6 };
/** Longest step of bonded grains [s]. */
const LONGEST_BOND_STEP = 0.25e-6;

/** In which the top wall comes all the way down, where the solver is fast enough [s]. */
const SECONDS_DOWN = 4;

/** How far the top wall comes down, as a share of the height at the start. */
export const lowest = (c: Choices): number => Math.exp(-lastStrain(c));

function timeStep(c: Choices): number {
  const step = WAY[c.model] / c.speed;
  return Number((c.model === "bonded" ? Math.min(step, LONGEST_BOND_STEP) : step).toPrecision(3));
}

/** Steps a second that the solver makes at most. */
export function pace(c: Choices): number {
  const height = Math.sqrt((c.grains * 2.9e-6) / firstFraction(c)); // of a square box of grains of 1.4 to 2.4 mm
  return ((1 - lowest(c)) * height) / (c.speed * timeStep(c)) / SECONDS_DOWN;
}

/** Text of a case file, in SI; solver/live_case.cpp reads this form of it, and so does the program. */
export function caseText(c: Choices): string {
  return `# Written by the live page of softgrain: its grains, squeezed at one speed. softgrain run case.toml
[experiment]
loading = "compaction"
model = "${c.model === "bonded" ? "bpm" : "mpm"}"
${grainLines(c)}
[contact]
friction = ${c.friction}
wall_friction = 0

[time]
step = ${timeStep(c)}  # s

[sample]
grains = ${c.grains}
packing_fraction = ${firstFraction(c)}
seed = ${c.seed}

[loading]
wall_velocity = ${c.speed}  # m/s
max_strain = ${lastStrain(c)}
`;
}

function grainLines(c: Choices): string {
  if (c.model === "bonded")
    return `
[bpm]
primaries = 60
library = 3
`;
  const plastic = `law = "von_mises"
yield_stress = 5e5  # Pa
hardening_modulus = 1e6  # Pa
`;
  return `
[mpm]
${c.model === "plastic" ? plastic : `law = "${c.law}"\n${c.law === "mooney_rivlin" ? "c01 = 5e5  # Pa\n" : ""}`}young_modulus = 1e7  # Pa
poisson_ratio = ${c.poisson}
cells = 6
`;
}

/** With a wall speed that the model of the grains allows. */
export function allowed(c: Choices): Choices {
  const [low, high] = SPEEDS[c.model];
  return { ...c, speed: Math.min(high, Math.max(low, c.speed)) };
}

/** The choices that differ from the defaults, for an address: "grains=12&model=bonded". */
export function toHash(c: Choices): string {
  const keys = Object.keys(DEFAULTS) as (keyof Choices)[];
  return keys
    .filter((key) => c[key] !== DEFAULTS[key])
    .map((key) => `${key}=${c[key]}`)
    .join("&");
}

/** Of an address; what cannot be is left at its default. */
export function fromHash(hash: string): Choices {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const c: Choices = { ...DEFAULTS };
  for (const key of Object.keys(RANGES) as (keyof typeof RANGES)[]) {
    const value = Number(given.get(key) ?? NaN);
    const [low, high] = RANGES[key];
    if (value >= low && value <= high)
      c[key] = key === "grains" || key === "seed" ? Math.round(value) : value;
  }
  const speed = Number(given.get("speed") ?? NaN);
  if (speed > 0) c.speed = speed;
  const model = given.get("model");
  if (model === "plastic" || model === "bonded") c.model = model;
  c.law = LAWS.find(([name]) => name === given.get("law"))?.[0] ?? c.law;
  return allowed(c);
}
