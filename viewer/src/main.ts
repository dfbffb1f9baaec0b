// The page: state, and what happens when it changes.
import { chainColour, Colouring, colourings, RangeOver, reranged } from "./colouring";
import { runColour } from "./colours";
import { onKey } from "./keys";
import { showForceKey, showLegend } from "./legend";
import { takePayloads } from "./payload";
import { Plots } from "./plots";
import { Pointer } from "./pointer";
import { showProvenance } from "./provenance";
import { Renderer } from "./renderer";
import { Run } from "./run";
import { savePicture } from "./save";
import { valueAt } from "./series";
import { toggleTheme } from "./theme";
import { short, withUnit } from "./units";

const $ = <T extends HTMLElement = HTMLElement>(selector: string) => document.querySelector<T>(selector)!;
const [slider, play, select, over, chains] = [
  $<HTMLInputElement>(".slider"),
  $<HTMLButtonElement>(".play"),
  $<HTMLSelectElement>(".colouring"),
  $<HTMLSelectElement>(".over"),
  $<HTMLInputElement>(".chains input"),
];

class Page {
  private shown = 0;
  private frame = 0;
  private playing = false;
  private highlight = -1;
  /** Ends of the colours that were typed [SI]. */
  private ends: { low?: number; high?: number } = {};
  private choices: Colouring[] = [];
  private renderer: Renderer | null = null;
  private plots: Plots;
  private drawPending = false;

  constructor(private runs: Run[]) {
    try {
      this.renderer = new Renderer($<HTMLCanvasElement>("canvas"));
    } catch (error) {
      say(`The packing cannot be drawn here (${(error as Error).message}); the curves and numbers can.`);
    }
    $("h1").textContent = document.title;
    this.showRunChooser();
    this.plots = new Plots($(".plots"), runs, (frame) => this.seek(frame));
    showProvenance($("footer"), runs);
    this.listen();
    this.showRun(0);
    this.seek(mostCompressed(this.run));
  }

  private get run(): Run {
    return this.runs[this.shown];
  }

  private listen(): void {
    slider.addEventListener("input", () => this.seek(Number(slider.value)));
    play.addEventListener("click", () => this.togglePlay());
    select.addEventListener("change", () => this.setEnds({}));
    over.addEventListener("change", () => this.setEnds({}));
    $(".save").addEventListener("click", () => this.save());
    chains.addEventListener("change", () => this.draw());
    $(".theme").addEventListener("click", () => this.toggleTheme());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.themeChanged());
    document.addEventListener("keydown", (event) =>
      onKey(event, {
        frame: this.frame,
        frames: this.run.frames,
        seek: (k) => this.seek(k),
        play: () => this.togglePlay(),
      }),
    );
    if (!this.renderer) return;
    new ResizeObserver(() => this.draw()).observe($(".stage"));
    new Pointer(
      $<HTMLCanvasElement>("canvas"),
      $(".tip"),
      this.renderer,
      () => this.frame,
      (grain) => {
        this.highlight = grain;
        this.draw();
      },
    );
  }

  private showRunChooser(): void {
    const chooser = $(".runs");
    chooser.hidden = this.runs.length < 2;
    this.runs.forEach((run, index) => {
      const button = document.createElement("button");
      button.role = "radio";
      button.style.setProperty("--run", runColour(index));
      button.textContent = run.name;
      button.addEventListener("click", () => this.showRun(index));
      chooser.append(button);
    });
  }

  showRun(index: number): void {
    const share = this.frame / Math.max(1, this.run.frames - 1);
    this.shown = index;
    this.highlight = -1;
    document
      .querySelectorAll(".runs button")
      .forEach((b, k) => b.setAttribute("aria-checked", String(k === index)));
    $(".summary").textContent = summary(this.run);
    const before = select.value;
    this.choices = colourings(this.run);
    select.replaceChildren(...this.choices.map((c) => new Option(c.label, c.key, false, c.key === before)));
    this.renderer?.show(this.run);
    $(".stage").style.setProperty(
      "--aspect",
      String(Math.min(1.6, Math.max(0.75, this.renderer?.aspect ?? 1))),
    );
    $(".chains").hidden = !this.renderer?.forceScale;
    $(".save").hidden = !this.renderer;
    this.ends = {};
    slider.max = String(this.run.frames - 1);
    this.seek(Math.round(share * (this.run.frames - 1)));
  }

  seek(frame: number): void {
    this.frame = Math.min(this.run.frames - 1, Math.max(0, frame));
    slider.value = String(this.frame);
    const now = this.now();
    $(".now").textContent = now;
    slider.setAttribute("aria-valuetext", now);
    this.plots.mark(this.shown, this.frame);
    document.body.dataset.frame = String(this.frame);
    this.draw();
  }

  /** "strain 0.213 · 1.2 ms · snapshot 8 of 25". */
  private now(): string {
    const { times } = this.run.header;
    const strain = valueAt(this.run.series, "strain", times[this.frame]);
    const words = [withUnit(times[this.frame], "s"), `snapshot ${this.frame + 1} of ${times.length}`];
    return (Number.isFinite(strain) ? [`strain ${short(strain)}`, ...words] : words).join(" · ");
  }

  private draw(): void {
    if (this.drawPending) return;
    this.drawPending = true;
    requestAnimationFrame(() => {
      this.drawPending = false;
      this.drawNow();
    });
  }

  private setEnds(ends: { low?: number; high?: number }): void {
    this.ends = ends;
    this.draw();
  }

  private get colouring(): Colouring | null {
    const chosen = this.choices.find((choice) => choice.key === select.value);
    return chosen ? reranged(this.run, chosen, over.value as RangeOver, this.frame, this.ends) : null;
  }

  private drawNow(): void {
    if (!this.renderer) return;
    const { colouring } = this;
    this.renderer.draw(this.frame, { colouring, chains: chains.checked, highlight: this.highlight });
    $(".over").hidden = !colouring || colouring.map === "categories";
    showLegend($(".legend"), colouring, (end, value) => this.setEnds({ ...this.ends, [end]: value }));
    const forceScale = chains.checked ? this.renderer.forceScale : null;
    showForceKey($(".force"), forceScale, this.renderer.pixelsPerMetre, chainColour(colouring));
    $("canvas").setAttribute(
      "aria-label",
      `Packing of ${this.run.name}, ${this.now()}, coloured by ${colouring?.label ?? "nothing"}`,
    );
    document.body.dataset.drawn = String(this.frame);
  }

  private save(): void {
    const { colouring, renderer } = this;
    if (!renderer) return;
    savePicture($<HTMLCanvasElement>("canvas"), {
      draw: (ratio) => renderer.draw(this.frame, { colouring, chains: chains.checked, highlight: -1 }, ratio),
      colouring,
      words: `${this.run.name}, ${this.now()}`,
      name: `${this.run.name.replaceAll("/", "-")}-${this.run.header.steps[this.frame]}.png`,
    });
    this.draw();
  }

  private togglePlay(): void {
    this.playing = !this.playing;
    play.textContent = this.playing ? "❚❚" : "▶";
    play.ariaLabel = this.playing ? "Pause" : "Play";
    if (!this.playing) return;
    if (this.frame === this.run.frames - 1) this.seek(0);
    this.playFrom(performance.now(), this.frame);
  }

  /** The whole run takes 5 to 20 s. */
  private playFrom(begin: number, first: number): void {
    const perSecond = Math.min(15, Math.max(5, this.run.frames / 12));
    const tick = (now: number) => {
      if (!this.playing) return;
      const frame = first + Math.floor(((now - begin) / 1000) * perSecond);
      if (frame > this.frame) this.seek(frame);
      if (this.frame >= this.run.frames - 1) this.togglePlay();
      else requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  private toggleTheme(): void {
    toggleTheme();
    this.themeChanged();
  }

  private themeChanged(): void {
    this.plots.redraw();
    this.draw();
  }
}

/** The frame with the largest strain; the last one where the series has none. */
function mostCompressed(run: Run): number {
  const strains = run.header.times.map((time) => valueAt(run.series, "strain", time));
  return strains.every(Number.isFinite) ? strains.indexOf(Math.max(...strains)) : run.frames - 1;
}

/** "compaction · mpm · 20 grains · friction 0.3". */
function summary(run: Run): string {
  const { experiment, contact } = run.header.settings;
  const words = [experiment?.loading, experiment?.model].filter(Boolean).map(String);
  if (run.grains > 1) words.push(`${run.grains} grains`);
  else if (!run.hasOutlines) words.push(`${run.column("particle.x", 0).length} primaries`);
  if (contact) words.push(`friction ${contact.friction}`);
  return words.join(" · ");
}

function say(words: string): void {
  $(".message").textContent = words;
  $(".message").hidden = false;
}

takePayloads()
  .then((payloads) => {
    if (payloads.length === 0)
      return say("This page is a template: `softgrain report RUN` puts a run into it.");
    new Page(payloads.map((payload) => new Run(payload)));
    document.body.dataset.ready = "true";
    return undefined;
  })
  .catch((error: Error) =>
    say(`This page could not be read: ${error.message}. It needs a browser of 2023 or later.`),
  );
