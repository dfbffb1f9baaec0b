import { centreOf, describe, pick } from "./pick";
import { Renderer } from "./renderer";
import { hideTip, showTip } from "./tip";

/**
 * The pointer over the packing: a grain's numbers, magnifying (double click, back with shift; two fingers) and
 * moving.
 */
export class Pointer {
  /** Middle and distance of the two fingers when they were last seen. */
  private pinch?: { x: number; y: number; distance: number };

  constructor(
    private canvas: HTMLCanvasElement,
    private tip: HTMLElement,
    private renderer: Renderer,
    private frame: () => number,
    private highlight: (grain: number) => void,
    active: () => boolean,
  ) {
    canvas.addEventListener("pointermove", (event) => active() && this.onMove(event));
    canvas.addEventListener("pointerdown", (event) => active() && this.onMove(event));
    canvas.addEventListener("pointerleave", () => active() && this.leave());
    canvas.addEventListener("dblclick", (event) => active() && this.onDoubleClick(event));
    canvas.addEventListener("touchmove", (event) => active() && this.onTouch(event), { passive: false });
    for (const kind of ["touchstart", "touchend", "touchcancel"] as const)
      canvas.addEventListener(kind, () => (this.pinch = undefined));
    document.addEventListener("keydown", () => this.leave());
  }

  /** What lies between two fingers stays between them; one finger scrolls the page. */
  private onTouch(event: TouchEvent): void {
    if (event.touches.length !== 2) return;
    event.preventDefault();
    const { left, top } = this.canvas.getBoundingClientRect();
    const [a, b] = event.touches;
    const x = (a.clientX + b.clientX) / 2 - left;
    const y = (a.clientY + b.clientY) / 2 - top;
    const distance = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY) || 1;
    if (this.pinch) {
      const scale = this.renderer.pixelsPerMetre;
      this.renderer.pan((x - this.pinch.x) / scale, (this.pinch.y - y) / scale);
      this.renderer.zoomAt(distance / this.pinch.distance, this.renderer.toWorld(x, y));
    }
    this.pinch = { x, y, distance };
    this.tip.hidden = true;
    this.highlight(-1);
  }

  private onMove(event: PointerEvent): void {
    const { renderer } = this;
    if (event.type === "pointermove" && event.buttons === 1) {
      const scale = renderer.pixelsPerMetre;
      renderer.pan(event.movementX / scale, -event.movementY / scale);
    }
    const [x, y] = renderer.toWorld(event.offsetX, event.offsetY);
    const picked = pick(renderer.run, renderer.places, x, y);
    this.highlight(picked?.kind === "grain" ? picked.index : -1);
    if (!picked) return hideTip(this.tip);
    const centre = centreOf(renderer.places, picked);
    showTip(this.tip, this.canvas, event, describe(renderer.run, this.frame(), picked, centre));
  }

  private leave(): void {
    if (this.tip.hidden) return;
    this.tip.hidden = true;
    this.highlight(-1);
  }

  private onDoubleClick(event: MouseEvent): void {
    this.renderer.zoomAt(event.shiftKey ? 0.5 : 2, this.renderer.toWorld(event.offsetX, event.offsetY));
    this.highlight(-1);
  }
}
