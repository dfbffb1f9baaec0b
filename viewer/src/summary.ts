import { Run } from "./run";
import { valueAt } from "./series";

/** The frame with the largest strain; the last one where the series has none. */
export function mostCompressed(run: Run): number {
  const strains = run.header.times.map((time) => valueAt(run.series, "strain", time));
  return strains.every(Number.isFinite) ? strains.indexOf(Math.max(...strains)) : run.frames - 1;
}

/** "compaction · mpm · 20 grains · friction 0.3". */
export function summary(run: Run): string {
  const { experiment, contact } = run.header.settings;
  const words = [experiment?.loading, experiment?.model].filter(Boolean).map(String);
  if (run.grains > 1) words.push(`${run.grains} grains`);
  else if (!run.hasOutlines) words.push(`${run.column("particle.x", 0).length} primaries`);
  if (contact) words.push(`friction ${contact.friction}`);
  return words.join(" · ");
}
