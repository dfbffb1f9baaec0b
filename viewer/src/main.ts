// The page: state, and what happens when it changes.
import { fromHash, toHash, View } from "./address";
import { chainColour, Colouring, colourings, RangeOver, reranged } from "./colouring";
import { runColour } from "./colours";
import { canFilm, saveFilm } from "./film";
import { onKey } from "./keys";
import { showForceKey, showLegend } from "./legend";
import { takePayloads } from "./payload";
import { Player } from "./player";
import { Plots } from "./plots";
import { Pointer } from "./pointer";
import { showProvenance } from "./provenance";
import { Drawing } from "./drawing";
import { Renderer } from "./renderer";
import { Run } from "./run";
import { Picture, savePicture } from "./save";
import { valueAt } from "./series";
import { SpaceControls } from "./space/controls";
import { Orbit } from "./space/orbit";
import { SpaceRenderer } from "./space/renderer";
import { mostCompressed, summary } from "./summary";
import { toggleTheme } from "./theme";
import { short, withUnit } from "./units";

const $ = <T extends HTMLElement = HTMLElement>(selector: string) => document.querySelector<T>(selector)!;
const [slider, play, select, over, log, chains, film] = [
  $<HTMLInputElement>(".slider"),
  $<HTMLButtonElement>(".play"),
  $<HTMLSelectElement>(".colouring"),
  $<HTMLSelectElement>(".over"),
  $<HTMLInputElement>(".log input"),
  $<HTMLInputElement>(".chains input"),
  $<HTMLButtonElement>(".film"),
];
/** Browsers refuse more changes of the address than a few a second. */
const ADDRESS_AFTER = 300;

class Page {
  private shown = 0;
  frame = 0;
  private highlight = -1;
  /** Ends of the colours that were typed [SI]. */
  private ends: { low?: number; high?: number } = {};
  private choices: Colouring[] = [];
  private drawings: { plane: Renderer; space: SpaceRenderer } | null = null;
  private space: SpaceControls | null = null;
  private plots: Plots;
  private player = new Player(play, this);
  private drawPending = false;
  private filming = false;
  private opening: View;
  private addressPending = 0;

  constructor(private runs: Run[]) {
    try {
      const canvas = $<HTMLCanvasElement>("canvas");
      this.drawings = { plane: new Renderer(canvas), space: new SpaceRenderer(canvas) };
      this.space = new SpaceControls($(".space"), this.drawings.space, () => this.draw());
    } catch (error) {
      say(`The packing cannot be drawn here (${(error as Error).message}); the curves and numbers can.`);
    }
    $("h1").textContent = document.title;
    this.showRunChooser();
    const changed = () => this.remember();
    this.plots = new Plots($(".plots"), runs, (frame) => this.seek(frame), changed);
    showProvenance($("footer"), runs);
    this.listen();
    chains.checked = !this.run.inSpace; // there they lie behind the surfaces
    this.showRun(0);
    this.seek(mostCompressed(this.run));
    this.opening = this.view;
    this.view = fromHash(location.hash, this.opening);
  }

  private get view(): View {
    const text = (end?: number) => (end === undefined ? "" : String(end));
    return {
      run: this.shown,
      frame: this.frame,
      colour: select.value,
      over: over.value,
      low: text(this.ends.low),
      high: text(this.ends.high),
      log: log.checked,
      chains: chains.checked,
      camera: this.run.inSpace ? (this.space?.camera ?? "") : "",
      cut: this.space?.cut ?? "",
      plots: this.plots.choices,
    };
  }

  private set view(view: View) {
    if (view.run !== this.shown && view.run < this.runs.length) this.showRun(view.run);
    if (this.choices.some(({ key }) => key === view.colour)) select.value = view.colour;
    if ([...over.options].some(({ value }) => value === view.over)) over.value = view.over;
    [log.checked, chains.checked] = [view.log, view.chains];
    this.plots.choices = view.plots;
    if (this.space) [this.space.camera, this.space.cut] = [view.camera, view.cut];
    const end = (text: string) => (text !== "" && Number.isFinite(Number(text)) ? Number(text) : undefined);
    this.setEnds({ low: end(view.low), high: end(view.high) });
    this.seek(view.frame);
  }

  /** Puts what is shown into the address, a moment later. */
  private remember(): void {
    clearTimeout(this.addressPending);
    this.addressPending = window.setTimeout(() => {
      const hash = toHash(this.view, this.opening);
      if (hash !== location.hash.slice(1)) history.replaceState(null, "", `#${hash}`);
    }, ADDRESS_AFTER);
  }

  get frames(): number {
    return this.run.frames;
  }
  private get run(): Run {
    return this.runs[this.shown];
  }
  private get renderer(): Drawing | null {
    return this.drawings && (this.run.inSpace ? this.drawings.space : this.drawings.plane);
  }

  private listen(): void {
    slider.addEventListener("input", () => this.seek(Number(slider.value)));
    select.addEventListener("change", () => this.setEnds({}));
    over.addEventListener("change", () => this.setEnds({}));
    $(".save").addEventListener("click", () => this.save());
    film.addEventListener("click", () => this.film());
    log.addEventListener("change", () => this.setEnds({}));
    chains.addEventListener("change", () => this.draw());
    window.addEventListener("hashchange", () => (this.view = fromHash(location.hash, this.opening)));
    $(".theme").addEventListener("click", () => this.toggleTheme());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.themeChanged());
    document.addEventListener("keydown", (event) =>
      onKey(event, {
        frame: this.frame,
        frames: this.run.frames,
        seek: (k) => this.seek(k),
        play: () => this.player.toggle(),
      }),
    );
    if (!this.drawings) return;
    new ResizeObserver(() => this.draw()).observe($(".stage"));
    const [canvas, tip] = [$<HTMLCanvasElement>("canvas"), $(".tip")];
    const highlight = (grain: number) => {
      this.highlight = grain;
      this.draw();
    };
    const { plane, space } = this.drawings;
    new Pointer(
      canvas,
      tip,
      plane,
      () => this.frame,
      highlight,
      () => !this.run.inSpace,
    );
    new Orbit(
      canvas,
      tip,
      space,
      () => this.frame,
      highlight,
      () => this.run.inSpace,
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
    if (this.space) this.space.hidden = !this.run.inSpace;
    $(".stage").classList.toggle("in-space", this.run.inSpace);
    $(".chains").hidden = !this.renderer?.forceScale;
    $(".save").hidden = !this.renderer;
    film.hidden = !this.renderer || !canFilm() || this.run.frames < 2;
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
    this.remember();
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
    return chosen
      ? reranged(this.run, chosen, over.value as RangeOver, this.frame, this.ends, log.checked)
      : null;
  }

  private drawNow(): void {
    if (!this.renderer || this.filming) return; // the film draws it, at its own size
    const { colouring } = this;
    this.renderer.draw(this.frame, { colouring, chains: chains.checked, highlight: this.highlight });
    $(".over").hidden = $(".log").hidden = !colouring || colouring.map === "categories";
    showLegend($(".legend"), colouring, (end, value) => this.setEnds({ ...this.ends, [end]: value }));
    const forceScale = chains.checked ? this.renderer.forceScale : null;
    const unit = this.run.inSpace ? "N" : "N/m";
    showForceKey($(".force"), forceScale, this.renderer.pixelsPerMetre, chainColour(colouring), unit);
    $("canvas").setAttribute(
      "aria-label",
      `Packing of ${this.run.name}, ${this.now()}, coloured by ${colouring?.label ?? "nothing"}`,
    );
    document.body.dataset.drawn = String(this.frame);
  }

  private get picture(): Picture {
    const { colouring, frame } = this;
    return {
      draw: (ratio) =>
        this.renderer!.draw(frame, { colouring, chains: chains.checked, highlight: -1 }, ratio),
      colouring,
      words: `${this.run.name}, ${this.now()}`,
    };
  }

  private save(): void {
    const name = `${this.run.name.replaceAll("/", "-")}-${this.run.header.steps[this.frame]}.png`;
    savePicture($<HTMLCanvasElement>("canvas"), this.picture, name);
    this.draw();
  }

  /** A film of all frames of this run, as they look now; a second click ends it earlier. */
  private async film(): Promise<void> {
    if (this.filming) {
      this.filming = false;
      return;
    }
    if (this.player.playing) this.player.toggle();
    this.filming = true;
    film.textContent = "stop";
    const [run, back] = [this.shown, this.frame];
    say("");
    const made = saveFilm($<HTMLCanvasElement>("canvas"), {
      frames: this.run.frames,
      perSecond: this.perSecond,
      picture: (frame) => {
        this.seek(frame);
        return this.picture;
      },
      name: this.run.name.replaceAll("/", "-"),
      stopped: () => !this.filming || this.shown !== run,
    });
    await made.catch((error: Error) => say(`This browser could not make the film: ${error.message}.`));
    this.filming = false;
    film.textContent = "save film";
    if (this.shown === run) this.seek(back);
  }

  /** Frames: the whole run takes 5 to 20 s. */
  get perSecond(): number {
    return Math.min(15, Math.max(5, this.run.frames / 12));
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

function say(words: string): void {
  $(".message").textContent = words;
  $(".message").hidden = words === "";
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
