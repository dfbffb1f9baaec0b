import uPlot from "uplot";
import { padded, polyline } from "../../src/plots";
import { scaleFor, short } from "../../src/units";
import { Numbers } from "./messages";

type Name = keyof Numbers;

interface Quantity {
  name: Name;
  label: string;
  unit: string;
}
const STRAIN: Quantity = { name: "strain", label: "strain ε", unit: "" };
const STRESS: Quantity = { name: "stress", label: "stress on the top wall", unit: "Pa" };
const PHI: Quantity = { name: "phi", label: "packing fraction Φ", unit: "" };
const Z: Quantity = { name: "z", label: "coordination number Z", unit: "" };

/** Points that a curve holds at most; then every other one is left out. */
const MOST_POINTS = 2000;

/** One quantity over another, in the order in which they came. */
class Curve {
  private figure = document.createElement("figure");
  private reading = document.createElement("output");
  private chart: uPlot;
  private factor = 1;

  constructor(
    parent: HTMLElement,
    private x: Quantity,
    private y: Quantity,
  ) {
    const caption = document.createElement("figcaption");
    caption.append(`${y.label} over ${x.label.split(" ").at(-1)}`, this.reading);
    this.figure.append(caption);
    parent.append(this.figure);
    this.chart = new uPlot(this.options(), [null, [[], []]] as unknown as uPlot.AlignedData, this.figure);
  }

  private options(): uPlot.Options {
    const colour = (name: string) => () => getComputedStyle(this.figure).getPropertyValue(name).trim();
    const axis = (size: number) => ({
      stroke: colour("--soft-ink"),
      grid: { stroke: colour("--line"), width: 1 },
      ticks: { stroke: colour("--line"), width: 1, size: 4 },
      font: "11px system-ui, sans-serif",
      size,
    });
    return {
      ...this.size(),
      mode: 2,
      legend: { show: false },
      cursor: { show: false },
      padding: [8, 12, 0, 0],
      scales: { x: { time: false, range: padded }, y: { range: padded } },
      series: [
        {},
        {
          facets: [
            { scale: "x", auto: true },
            { scale: "y", auto: true },
          ],
          stroke: colour("--accent"),
          width: 1.75,
          paths: polyline,
          points: { show: false },
        },
      ],
      axes: [axis(26), axis(44)],
    };
  }

  private size(): { width: number; height: number } {
    return { width: Math.max(200, this.figure.clientWidth - 24), height: 150 };
  }

  show(rows: Numbers[]): void {
    const largest = rows.reduce((most, row) => Math.max(most, Math.abs(row[this.y.name])), 0);
    const { factor, unit } = scaleFor(largest, this.y.unit);
    this.factor = factor;
    const data = [rows.map((row) => row[this.x.name]), rows.map((row) => row[this.y.name] * this.factor)];
    this.chart.setData([null, data] as unknown as uPlot.AlignedData);
    const last = rows.at(-1);
    this.reading.textContent = last ? `${short(last[this.y.name] * factor)}${unit ? " " + unit : ""}` : "";
  }

  resize(): void {
    this.chart.setSize(this.size());
  }
  redraw(): void {
    this.chart.redraw(false, true);
  }
}

export class Curves {
  private rows: Numbers[] = [];
  private curves: Curve[];

  constructor(parent: HTMLElement) {
    const pairs = [
      [STRAIN, STRESS],
      [STRAIN, PHI],
      [PHI, Z],
    ];
    this.curves = pairs.map(([x, y]) => new Curve(parent, x, y));
    new ResizeObserver(() => this.curves.forEach((curve) => curve.resize())).observe(parent);
  }

  reset(): void {
    this.rows = [];
  }

  add(row: Numbers): void {
    if (this.rows.at(-1)?.step === row.step) return;
    this.rows.push(row);
    if (this.rows.length > MOST_POINTS) this.rows = this.rows.filter((_, k) => k % 2 === 0);
  }

  draw(): void {
    for (const curve of this.curves) curve.show(this.rows);
  }
  redraw(): void {
    for (const curve of this.curves) curve.redraw();
  }
}
