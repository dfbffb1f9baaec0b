/** series.csv: columns by name, in SI units. */
export interface Series {
  rows: number;
  columns: Map<string, { unit: string; values: Float64Array }>;
}

export function parseSeries(text: string): Series {
  const lines = text.split("\n").filter((line) => line !== "");
  const headings = lines.length > 0 ? lines[0].split(",") : [];
  const rows = lines.slice(1).map((line) => line.split(",").map(Number));
  const columns: Series["columns"] = new Map();
  headings.forEach((heading, k) => {
    const [, name, unit] = /^([^[]*)(?:\[(.*)\])?$/.exec(heading.trim()) ?? [];
    columns.set(name, { unit: unit ?? "", values: Float64Array.from(rows, (row) => row[k] ?? NaN) });
  });
  return { rows: rows.length, columns };
}

/** Linear in time between rows. */
export function valueAt(series: Series, name: string, time: number): number {
  const times = series.columns.get("time")?.values;
  const values = series.columns.get(name)?.values;
  if (!times || !values || times.length === 0) return NaN;
  let next = times.findIndex((t) => t >= time);
  if (next < 0) next = times.length - 1;
  if (next === 0 || times[next] === times[next - 1]) return values[next];
  const s = Math.min(1, (time - times[next - 1]) / (times[next] - times[next - 1]));
  return (1 - s) * values[next - 1] + s * values[next];
}
