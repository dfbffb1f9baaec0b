import { short } from "../../src/units";
import { allowed, Choices, LAWS, Model, RANGES, SPEEDS } from "./case";

const ABOUT: Record<Model, string> = {
  elastic: "Rubber-like grains of material points (MPM), E = 10 MPa, touching by exact nonsmooth contact.",
  plastic: "The same points, but of a metal-like material: they flow at 0.5 MPa and keep their shape.",
  bonded:
    "Aggregates of 60 rigid disks that attract each other (BPM): a grain flows, but may not be pressed denser.",
};

/** Wall speeds go by factors: tenfold for each whole step of the slider. */
const toSlider = (speed: number): number => Math.log10(speed);
const toSpeed = (slider: number): number => Number((10 ** slider).toPrecision(2));

type Ranged = keyof typeof RANGES | "speed";
const RANGED = [...Object.keys(RANGES), "speed"] as Ranged[];

/** The form of the choices; tells every change that is complete. */
export class Controls {
  constructor(
    private form: HTMLFormElement,
    private choices: Choices,
    private changed: (choices: Choices) => void,
  ) {
    this.select.append(...LAWS.map(([name, words]) => new Option(words, name)));
    for (const name of RANGED) {
      const input = this.input(name);
      input.addEventListener("input", () => this.say(this.read()));
      input.addEventListener("change", () => this.take());
    }
    this.form
      .querySelectorAll("[name=model], [name=law]")
      .forEach((input) => input.addEventListener("change", () => this.take()));
    this.form.querySelector(".dice")!.addEventListener("click", () => {
      this.input("seed").value = String(1 + Math.floor(Math.random() * 9999));
      this.take();
    });
    this.form.addEventListener("submit", (event) => event.preventDefault());
    this.show(choices);
  }

  show(choices: Choices): void {
    this.choices = choices;
    for (const name of RANGED) {
      const input = this.input(name);
      const ends = name === "speed" ? SPEEDS[choices.model].map(toSlider) : RANGES[name];
      [input.min, input.max] = ends.map(String);
    }
    for (const name of RANGED)
      this.input(name).value = String(name === "speed" ? toSlider(choices.speed) : choices[name]);
    this.select.value = choices.law;
    for (const radio of this.models) radio.checked = radio.value === choices.model;
    this.say(choices);
  }

  private get models(): NodeListOf<HTMLInputElement> {
    return this.form.querySelectorAll<HTMLInputElement>("[name=model]");
  }
  private get select(): HTMLSelectElement {
    return this.form.querySelector("select")!;
  }
  private input(name: string): HTMLInputElement {
    return this.form.querySelector(`[name=${name}]`)!;
  }

  private read(): Choices {
    const number = (name: keyof typeof RANGES) => {
      const [low, high] = RANGES[name];
      const value = this.input(name).valueAsNumber;
      return Number.isFinite(value) ? Math.min(high, Math.max(low, value)) : this.choices[name];
    };
    const model = [...this.models].find((radio) => radio.checked)!.value as Model;
    return allowed({
      model,
      law: this.select.value,
      grains: number("grains"),
      friction: number("friction"),
      poisson: number("poisson"),
      speed: toSpeed(this.input("speed").valueAsNumber),
      seed: Math.round(number("seed")),
    });
  }

  private take(): void {
    this.show(this.read());
    this.changed(this.choices);
  }

  private say(choices: Choices): void {
    const words: Partial<Record<Ranged, string>> = { speed: `${short(choices.speed)} m/s` };
    for (const name of RANGED) {
      const output = this.input(name).parentElement!.querySelector("output");
      if (output) output.textContent = words[name] ?? short(choices[name]);
    }
    this.form.querySelector(".about")!.textContent = ABOUT[choices.model];
    const rows = this.form.querySelectorAll<HTMLElement>(".of-points");
    rows.forEach((row) => (row.hidden = choices.model === "bonded"));
    this.select.parentElement!.hidden = choices.model !== "elastic";
  }
}
