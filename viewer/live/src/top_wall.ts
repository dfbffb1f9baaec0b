import { Drawing } from "./drawing";

/** The handle of the top wall: a pointer drags it, arrow keys move it. */
export class TopWall {
  private held: number | null = null; // from the pointer to the wall [pixels]
  private height = 1;
  private goal = 1;
  private most = 1;

  constructor(
    private handle: HTMLElement,
    private drawing: Drawing,
    private drive: (height: number) => void,
  ) {
    handle.addEventListener("pointerdown", (event) => {
      handle.setPointerCapture(event.pointerId);
      this.held = drawing.toPixels(this.height) - this.above(event);
    });
    handle.addEventListener("pointermove", (event) => {
      if (this.held !== null) drive(drawing.toHeight(this.above(event) + this.held));
    });
    for (const end of ["pointerup", "pointercancel"] as const)
      handle.addEventListener(end, () => (this.held = null));
    handle.addEventListener("keydown", (event) => this.onKey(event));
  }

  /** Of the pointer [pixels from the top of the stage]. */
  private above(event: PointerEvent): number {
    return event.clientY - this.handle.parentElement!.getBoundingClientRect().top;
  }

  private onKey(event: KeyboardEvent): void {
    const ways: Record<string, number> = { ArrowDown: -0.02, ArrowUp: 0.02, PageDown: -0.1, PageUp: 0.1 };
    const way = ways[event.key] ?? (event.key === "End" ? -1 : event.key === "Home" ? 1 : 0);
    if (way === 0) return;
    event.preventDefault();
    this.drive(this.goal + way * this.most);
  }

  place(height: number, goal: number, most: number): void {
    [this.height, this.goal, this.most] = [height, goal, most];
    const [left, width] = this.drawing.sides;
    this.handle.style.transform = `translate(${left}px, ${this.drawing.toPixels(height)}px)`;
    this.handle.style.width = `${width}px`;
    this.handle.ariaValueNow = String(Math.round((100 * height) / most));
    this.handle.ariaValueText = `${Math.round((100 * height) / most)} % of the height at the start`;
  }
}
