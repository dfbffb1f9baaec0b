import { contactsOfGrains, sizeChange } from "./colouring";
import { Places } from "./picture";
import { Run } from "./run";
import { short, withUnit } from "./units";

/** What lies under the pointer. */
export interface Picked {
  kind: "grain" | "particle";
  index: number;
}

export function pick(run: Run, p: Places, x: number, y: number): Picked | null {
  if (run.hasOutlines) {
    for (let g = 0; g < run.grains; ++g)
      if (isInside(p, run.outlineBegin[g], run.outlineBegin[g + 1], x, y)) return { kind: "grain", index: g };
    return null;
  }
  for (let i = 0; i < p.x.length; ++i) {
    if (Math.hypot(p.x[i] - x, p.y[i] - y) > p.radius[i]) continue;
    return p.grain.length > 0 && run.grains > 1
      ? { kind: "grain", index: p.grain[i] }
      : { kind: "particle", index: i };
  }
  return null;
}

/** Of what was picked [m]. */
export function centreOf(p: Places, { kind, index }: Picked): number[] {
  return kind === "grain" ? [p.grainX[index], p.grainY[index]] : [p.x[index], p.y[index]];
}

/** Is the point inside the polygon? By the parity of crossings. */
function isInside(p: Places, begin: number, end: number, x: number, y: number): boolean {
  let inside = false;
  for (let v = begin, w = end - 1; v < end; w = v++) {
    const [xv, yv, xw, yw] = [p.outlineX[v], p.outlineY[v], p.outlineX[w], p.outlineY[w]];
    if (yv > y !== yw > y && x < ((xw - xv) * (y - yv)) / (yw - yv) + xv) inside = !inside;
  }
  return inside;
}

/** Its numbers: pairs of a heading and what stands beside it; centre: of it [m]. */
export function describe(
  run: Run,
  frame: number,
  { kind, index }: Picked,
  centre: number[],
): [string, string][] {
  const of = (name: string) => run.column(`${kind}.${name}`, frame)[index];
  const lines: [string, string][] = [];
  for (const { name, label, unit } of run.header.fields)
    if (run.has(`${kind}.${name}`))
      lines.push([kind === "grain" ? `mean ${label}` : label, withUnit(of(name), unit)]);
  for (const [size, factor, unit] of [
    ["area", 1e6, "mm²"],
    ["volume", 1e9, "mm³"],
  ] as const) {
    if (kind !== "grain" || !run.has(`grain.${size}`)) continue;
    lines.push([size, `${short(factor * of(size))} ${unit}`]);
    lines.push([`change of ${size}`, `${short(sizeChange(run, size, frame)[index])} %`]);
  }
  if (kind === "grain" && run.grains > 1)
    lines.push(["contacts", String(contactsOfGrains(run, frame)[index])]);
  if (kind === "particle") lines.push(["radius", withUnit(of("radius"), "m")]);
  lines.push(["centre", centre.map((x) => withUnit(x, "m")).join(", ")]);
  return [[kind === "grain" ? `Grain ${index}` : `Primary ${index}`, ""], ...lines];
}
