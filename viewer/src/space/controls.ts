import { Cut, SpaceRenderer } from "./renderer";

/** Where the packing is cut, and back to the first view; hidden in the plane. */
export class SpaceControls {
  constructor(
    private place: HTMLElement,
    private renderer: SpaceRenderer,
    changed: () => void,
  ) {
    for (const input of [this.axis, this.share])
      input.addEventListener("input", () => {
        this.take();
        changed();
      });
    this.reset.addEventListener("click", () => {
      renderer.camera.reset();
      changed();
    });
  }

  set hidden(hidden: boolean) {
    this.place.hidden = hidden;
  }

  /** Of the camera and the cut, for the address: "-62,18,1" and "x,0.5". */
  get camera(): string {
    return this.renderer.camera.text;
  }
  set camera(words: string) {
    this.renderer.camera.text = words;
  }
  get cut(): string {
    const { axis, share } = this.renderer.cut;
    return axis === "" ? "" : `${axis},${share}`;
  }
  set cut(words: string) {
    const [axis, share] = words.split(",");
    const known =
      [...this.axis.options].some(({ value }) => value === axis) && Number.isFinite(Number(share));
    this.axis.value = known ? axis : "";
    if (known) this.share.value = share;
    this.take();
  }

  private take(): void {
    this.renderer.cut = { axis: this.axis.value as Cut["axis"], share: Number(this.share.value) };
    this.share.hidden = this.axis.value === "";
  }
  private get axis(): HTMLSelectElement {
    return this.place.querySelector("select")!;
  }
  private get share(): HTMLInputElement {
    return this.place.querySelector("input")!;
  }
  private get reset(): HTMLButtonElement {
    return this.place.querySelector("button")!;
  }
}
