// The live page: choices, the worker that computes, and the pictures that it sends.
import { gradient } from "../../src/colours";
import { toggleTheme } from "../../src/theme";
import { withUnit } from "../../src/units";
import { caseText, Choices, fromHash, lowest, pace, toHash } from "./case";
import { Controls } from "./controls";
import { Curves } from "./curves";
import { Drawing } from "./drawing";
import { Link } from "./link";
import { FromSolver, Picture } from "./messages";
import { TopWall } from "./top_wall";

const $ = <T extends HTMLElement = HTMLElement>(selector: string) => document.querySelector<T>(selector)!;

/** Time between two drawings of the curves [ms], and of two counts of pictures. */
const CURVES_EVERY = 80;
const COUNT_EVERY = 1000;

class Page {
  private choices: Choices = fromHash(location.hash);
  private drawing = new Drawing($<HTMLCanvasElement>("canvas"));
  private curves = new Curves($(".plots"));
  private wall = new TopWall($(".top-wall"), this.drawing, (height) => this.drive(height));
  private controls: Controls;
  private link: Link;
  private picture: Picture | null = null;
  private fresh = false; // the picture was not drawn yet
  private behind = false; // it took the place of one that was not drawn: the solver waits
  private stale = true; // what is drawn is not what is chosen
  private startHeight = 1;
  private goal = 1;
  private paused = false;
  private over = false;
  private ready = false; // the solver
  private secondsPerStep = 0;
  private curvesAt = 0;
  private count = { since: 0, frames: 0, pictures: 0 };

  constructor() {
    this.controls = new Controls($<HTMLFormElement>(".settings"), this.choices, (choices) =>
      this.choose(choices),
    );
    this.link = new Link((message) => this.hear(message));
    this.listen();
    requestAnimationFrame((now) => this.frame(now));
  }

  private listen(): void {
    $(".squeeze").addEventListener("click", () => this.drive(0));
    $(".release").addEventListener("click", () => this.drive(this.startHeight));
    $(".pause").addEventListener("click", () => this.pause(!this.paused));
    $(".reset").addEventListener("click", () => this.begin());
    $(".chains").addEventListener("change", () => (this.stale = true));
    $(".download").addEventListener("click", () => this.download());
    $(".theme").addEventListener("click", () => this.toggleTheme());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.themeChanged());
    new ResizeObserver(() => (this.stale = true)).observe($(".stage"));
    window.addEventListener("hashchange", () => {
      if (location.hash.slice(1) === toHash(this.choices)) return;
      this.controls.show(fromHash(location.hash));
      this.choose(fromHash(location.hash));
    });
    $(".bar").style.background = gradient("cividis");
  }

  private choose(choices: Choices): void {
    this.choices = choices;
    history.replaceState(null, "", "#" + toHash(choices));
    this.begin();
  }

  begin(): void {
    if (!this.ready) return;
    this.curves.reset();
    this.drawing.reset();
    this.over = false;
    say("");
    this.pause(false);
    hint("Preparing the grains ...");
    this.link.say({ kind: "begin", text: this.caseText, pace: pace(this.choices) });
  }

  get caseText(): string {
    return caseText(this.choices);
  }

  private hear(message: FromSolver): void {
    if (message.kind === "ready") {
      this.ready = true;
      this.begin();
    } else if (message.kind === "began") {
      this.startHeight = this.goal = message.height;
      hint("Drag the top wall down");
    } else if (message.kind === "over") {
      this.over = true;
      say(message.words + ". Start again, or choose other grains.");
    } else {
      // One picture waits to be drawn while another may come: else each would wait for a frame and then for a step.
      if (this.fresh) this.behind = true;
      else this.link.say({ kind: "drawn" });
      this.picture = message.picture;
      if (message.secondsPerStep > 0) this.secondsPerStep = message.secondsPerStep;
      this.curves.add(message.picture.numbers);
      this.fresh = true;
      this.count.pictures += 1;
    }
  }

  private drive(height: number): void {
    if (this.over) return;
    this.goal = Math.min(this.startHeight, Math.max(lowest(this.choices) * this.startHeight, height));
    hint("");
    this.stale = true;
    if (this.paused) this.pause(false);
    this.link.say({ kind: "drive", height: this.goal });
  }

  private pause(paused: boolean): void {
    this.paused = paused;
    $(".pause").textContent = paused ? "Go on" : "Pause";
    this.link.say({ kind: "pause", paused });
  }

  /** Draws what there is; the solver's next picture is on its way meanwhile. */
  private frame(now: number): void {
    requestAnimationFrame((next) => this.frame(next));
    this.countFrames(now);
    if (!this.picture || (!this.fresh && !this.stale)) return;
    if (this.behind) this.link.say({ kind: "drawn" });
    const { numbers } = this.picture;
    this.drawing.draw(
      this.picture,
      this.startHeight,
      this.goal,
      $<HTMLInputElement>(".chains input").checked,
    );
    this.wall.place(numbers.height, this.goal, this.startHeight);
    $(".most").textContent = withUnit(this.drawing.pressure, "Pa");
    this.fresh = this.stale = this.behind = false;
    document.body.dataset.drawn = String(numbers.step);
    if (now - this.curvesAt < CURVES_EVERY) return;
    this.curvesAt = now;
    this.curves.draw();
  }

  private countFrames(now: number): void {
    this.count.frames += 1;
    const passed = now - this.count.since;
    if (passed < COUNT_EVERY) return;
    const rate = (events: number) => Math.round((1000 * events) / passed);
    const { frames, pictures } = this.count;
    this.count = { since: now, frames: 0, pictures: 0 };
    Object.assign(document.body.dataset, { frames: rate(frames), pictures: rate(pictures) });
    if (this.secondsPerStep > 0)
      $(".speed").textContent =
        `${withUnit(this.secondsPerStep, "s")} a step, ${rate(pictures)} pictures a second`;
    this.curves.draw();
  }

  private download(): void {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([this.caseText], { type: "application/toml" }));
    link.download = "case.toml";
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
  }

  /** All numbers after so many steps of squeezing from the start, for tests. */
  async numbersAfter(steps: number): Promise<Picture["numbers"]> {
    this.begin();
    this.pause(true);
    this.link.say({ kind: "drive", height: 0 });
    this.link.say({ kind: "steps", count: steps });
    while (this.picture?.numbers.step !== steps && !this.over)
      await new Promise((done) => setTimeout(done, 20));
    return this.picture!.numbers;
  }

  private toggleTheme(): void {
    toggleTheme();
    this.themeChanged();
  }

  private themeChanged(): void {
    this.curves.redraw();
    this.stale = true;
  }
}

function hint(words: string): void {
  $(".hint").textContent = words;
}

function say(words: string): void {
  $(".message").textContent = words;
  $(".message").hidden = words === "";
}

Object.assign(window, { live: new Page() });
