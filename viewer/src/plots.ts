import uPlot from "uplot";
import { runColour } from "./colours";
import { Run } from "./run";
import { valueAt } from "./series";
import { label, scaleFor, Scale, short } from "./units";

/** The first pair of columns that the runs have is shown at the start. */
const FIRST: [string, string][] = [
  ["strain", "stress_top"],
  ["strain", "stress_bottom"],
  ["time", "wall_height"],
];
const SECOND: [string, string][] = [
  ["phi", "z"],
  ["phi_0", "z"],
  ["strain", "area_ratio"],
  ["strain", "contacts"],
  ["time", "kinetic_energy"],
];
const HIDDEN = new Set(["step", "leg", "wall_seconds"]);

/** A curve of every run through two chosen columns, with a dot at the time of the picture. */
class Plot {
  readonly element = document.createElement("figure");
  private dot = document.createElement("div");
  private chart?: uPlot;
  private selects: [HTMLSelectElement, HTMLSelectElement];
  private log = document.createElement("input");
  private reading = document.createElement("output");
  private scales: [Scale, Scale] = [
    { factor: 1, unit: "" },
    { factor: 1, unit: "" },
  ];
  private shown = 0;
  private frame = 0;

  constructor(
    private runs: Run[],
    columns: string[],
    start: [string, string],
    private seek: (frame: number) => void,
    private changed: () => void,
  ) {
    const [y, x] = [start[1], start[0]].map((chosen) => this.select(columns, chosen));
    this.selects = [x, y];
    const caption = document.createElement("figcaption");
    y.ariaLabel = "Vertical axis";
    x.ariaLabel = "Horizontal axis";
    this.log.type = "checkbox";
    this.log.addEventListener("change", () => this.choose());
    const log = document.createElement("label");
    log.className = "log";
    log.title = "Vertical axis over powers of ten";
    log.append(this.log, " log");
    caption.append(y, " over ", x, log, this.reading);
    this.dot.className = "dot";
    this.element.append(caption);
    this.element.addEventListener("click", (event) => this.onClick(event));
  }

  private select(columns: string[], chosen: string): HTMLSelectElement {
    const select = document.createElement("select");
    for (const column of columns) select.append(new Option(label(column), column, false, column === chosen));
    select.addEventListener("change", () => this.choose());
    return select;
  }

  private choose(): void {
    this.build();
    this.changed();
  }

  /** "strain,stress_top", or "strain,stress_top,log". */
  get choice(): string {
    return [...this.selects.map((select) => select.value), ...(this.log.checked ? ["log"] : [])].join();
  }

  /** Takes such words, as far as there are such columns. */
  set choice(words: string) {
    const [x, y, log] = words.split(",");
    [x, y].forEach((column, k) => {
      if ([...this.selects[k].options].some(({ value }) => value === column)) this.selects[k].value = column;
    });
    this.log.checked = log === "log";
    this.build();
  }

  private values(run: Run, axis: 0 | 1): number[] {
    const column = run.series.columns.get(this.selects[axis].value);
    const values = [...(column?.values ?? [])].map((value) => value * this.scales[axis].factor);
    return axis === 1 && this.log.checked ? values.map((value) => (value > 0 ? value : NaN)) : values;
  }

  build(): void {
    this.chart?.destroy();
    this.scales = this.selects.map((select) => {
      const columns = this.runs.map((run) => run.series.columns.get(select.value));
      const largest = columns
        .flatMap((c) => [...(c?.values ?? [])])
        .reduce((m, v) => Math.max(m, Math.abs(v) || 0), 0);
      return scaleFor(largest, columns.find((c) => c)?.unit ?? "");
    }) as [Scale, Scale];
    const data = this.runs.map((run) => [this.values(run, 0), this.values(run, 1)]);
    const options = this.options(data.flatMap(([, y]) => y));
    this.chart = new uPlot(options, [null, ...data] as unknown as uPlot.AlignedData, this.element);
    this.chart.over.append(this.dot);
    this.mark(this.shown, this.frame);
  }

  /** y: all that is drawn, along the vertical axis. */
  private options(y: number[]): uPlot.Options {
    const ink = () => getComputedStyle(this.element).getPropertyValue("--soft-ink").trim();
    const line = () => getComputedStyle(this.element).getPropertyValue("--line").trim();
    const axis = (k: 0 | 1) => {
      const { unit } = this.scales[k];
      const text = label(this.selects[k].value) + (unit ? ` [${unit}]` : "");
      return {
        label: text,
        stroke: ink,
        grid: { stroke: line, width: 1 },
        ticks: { stroke: line, width: 1, size: 5 },
        font: "12px system-ui, sans-serif",
        labelFont: "12px system-ui, sans-serif",
        labelSize: 18,
        size: k === 0 ? 34 : 50,
      };
    };
    const curve = (index: number): uPlot.Series => ({
      facets: [
        { scale: "x", auto: true },
        { scale: "y", auto: true },
      ],
      stroke: runColour(index),
      width: 1.75,
      paths: polyline,
      points: { show: false },
    });
    return {
      ...this.size(),
      mode: 2,
      legend: { show: false },
      cursor: { show: false },
      hooks: { draw: [() => this.mark(this.shown, this.frame)] }, // its scales are known then
      padding: [10, 14, 0, 0],
      scales: {
        x: { time: false, range: padded },
        y: this.log.checked ? { distr: 3, range: decades(y) } : { range: padded },
      },
      series: [{}, ...this.runs.map((_, index) => curve(index))],
      axes: [axis(0), axis(1)],
    };
  }

  private size(): { width: number; height: number } {
    const width = Math.max(220, this.element.clientWidth);
    return { width, height: Math.round(Math.min(330, Math.max(220, 0.62 * width))) };
  }

  resize(): void {
    this.chart?.setSize(this.size());
    this.mark(this.shown, this.frame);
  }

  redraw(): void {
    this.chart?.redraw(false, true);
  }

  /** Where a frame of a run lies on the curve [CSS pixels], and its numbers. */
  private place(run: Run, frame: number): { left: number; top: number; x: number; y: number } {
    const at = (axis: 0 | 1) =>
      valueAt(run.series, this.selects[axis].value, run.header.times[frame]) * this.scales[axis].factor;
    const [x, y] = [at(0), at(1)];
    return { left: this.chart!.valToPos(x, "x"), top: this.chart!.valToPos(y, "y"), x, y };
  }

  mark(shown: number, frame: number): void {
    [this.shown, this.frame] = [shown, frame];
    if (!this.chart) return;
    const { left, top, x, y } = this.place(this.runs[shown], frame);
    this.dot.hidden = !Number.isFinite(left + top);
    this.dot.style.transform = `translate(${left}px, ${top}px)`;
    this.dot.style.background = runColour(shown);
    const units = this.scales.map(({ unit }) => (unit ? " " + unit : ""));
    this.reading.textContent = this.dot.hidden ? "" : `${short(y)}${units[1]} at ${short(x)}${units[0]}`;
  }

  /** Goes to the snapshot nearest on the paper: with unloading, a curve passes a strain more than once. */
  private onClick(event: MouseEvent): void {
    const over = this.chart?.over;
    if (!over || !(event.target instanceof Node) || !over.contains(event.target)) return;
    const box = over.getBoundingClientRect();
    const run = this.runs[this.shown];
    const distances = run.header.times.map((_, frame) => {
      const { left, top } = this.place(run, frame);
      return Math.hypot(left - event.clientX + box.left, top - event.clientY + box.top) || Infinity;
    });
    this.seek(distances.indexOf(Math.min(...distances)));
  }
}

/** Through all points in the order of time. */
export const polyline: uPlot.Series.PathBuilder = (u, index) => {
  const [xs, ys] = u.data[index] as unknown as number[][];
  const path = new Path2D();
  let pen = false;
  xs.forEach((x, i) => {
    const [px, py] = [u.valToPos(x, "x", true), u.valToPos(ys[i], "y", true)];
    const drawn = Number.isFinite(px + py);
    if (drawn && pen) path.lineTo(px, py);
    else if (drawn) path.moveTo(px, py);
    pen = drawn;
  });
  return {
    stroke: path,
    fill: null,
    clip: null,
    band: null,
    gaps: null,
    flags: 0,
  } as unknown as uPlot.Series.Paths;
};

/** A little more than the data, from 0 where that is near. */
export function padded(_: uPlot, low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || !Number.isFinite(low + high)) return [0, 1];
  const pad = 0.04 * (high - low) || Math.abs(high) || 1;
  return [low >= 0 && low < 0.3 * high ? Math.min(0, low) : low - pad, high + pad];
}

/** Whole powers of ten around the data, six at most. */
function decades(values: number[]): [number, number] {
  const known = values.filter(Number.isFinite);
  if (known.length === 0) return [0.1, 1];
  const [least, most] = known.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
  const top = Math.max(Math.ceil(Math.log10(most)), Math.floor(Math.log10(least)) + 1);
  return [10 ** Math.max(top - 6, Math.floor(Math.log10(least))), 10 ** top];
}

export class Plots {
  private plots: Plot[] = [];

  constructor(parent: HTMLElement, runs: Run[], seek: (frame: number) => void, changed: () => void) {
    const columns = [...new Set(runs.flatMap((run) => [...run.series.columns.keys()]))].filter(
      (c) => !HIDDEN.has(c),
    );
    const there = (pair: [string, string]) => pair.every((column) => columns.includes(column));
    for (const pairs of [FIRST, SECOND]) {
      const start = pairs.find(there);
      if (start) this.plots.push(new Plot(runs, columns, start, seek, changed));
    }
    parent.append(...this.plots.map((plot) => plot.element));
    parent.hidden = this.plots.length === 0;
    for (const plot of this.plots) plot.build();
    new ResizeObserver(() => this.plots.forEach((plot) => plot.resize())).observe(parent);
  }

  get choices(): string[] {
    return this.plots.map((plot) => plot.choice);
  }
  set choices(words: string[]) {
    this.plots.forEach((plot, k) => {
      if (words[k] !== undefined && words[k] !== plot.choice) plot.choice = words[k];
    });
  }
  mark(shown: number, frame: number): void {
    for (const plot of this.plots) plot.mark(shown, frame);
  }
  redraw(): void {
    for (const plot of this.plots) plot.redraw();
  }
}
