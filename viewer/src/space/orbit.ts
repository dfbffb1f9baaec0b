import { describe } from "../pick";
import { hideTip, showTip } from "../tip";
import { SpaceRenderer } from "./renderer";

const DEGREES_A_PIXEL = 0.4;

/**
 * The pointer over a packing in space: dragging turns it (with shift, or the right button, moves it), double click or
 * the wheel with ctrl magnifies; one finger turns, two fingers move and magnify. A grain's numbers under the pointer.
 */
export class Orbit {
  /** Middle and distance of the fingers when they were last seen. */
  private fingers?: { x: number; y: number; distance: number; count: number };

  constructor(
    private canvas: HTMLCanvasElement,
    private tip: HTMLElement,
    private renderer: SpaceRenderer,
    private frame: () => number,
    private changed: (grain: number) => void,
    private active: () => boolean,
  ) {
    const listen = <K extends keyof HTMLElementEventMap>(
      kind: K,
      take: (event: HTMLElementEventMap[K]) => void,
      options?: AddEventListenerOptions,
    ) => canvas.addEventListener(kind, (event) => this.active() && take(event), options);
    listen("pointermove", (event) => this.onMove(event));
    listen("pointerleave", () => this.leave());
    listen("dblclick", (event) => this.zoom(event.shiftKey ? 0.5 : 2, event.offsetX, event.offsetY));
    listen("wheel", (event) => this.onWheel(event), { passive: false });
    listen("contextmenu", (event) => event.preventDefault());
    listen("touchmove", (event) => this.onTouch(event), { passive: false });
    for (const kind of ["touchstart", "touchend", "touchcancel"] as const)
      listen(kind, () => (this.fingers = undefined));
  }

  private onMove(event: PointerEvent): void {
    if (event.pointerType === "touch") return; // see onTouch
    const { camera } = this.renderer;
    if (event.buttons === 2 || (event.buttons === 1 && event.shiftKey))
      this.pan(event.movementX, event.movementY);
    else if (event.buttons === 1)
      camera.turn(-DEGREES_A_PIXEL * event.movementX, DEGREES_A_PIXEL * event.movementY);
    if (event.buttons !== 0) {
      this.tip.hidden = true;
      this.changed(-1);
      return;
    }
    const grain = this.renderer.pick(event.offsetX, event.offsetY);
    this.changed(grain);
    if (grain < 0) return hideTip(this.tip);
    const { run } = this.renderer;
    const lines = describe(run, this.frame(), { kind: "grain", index: grain }, this.renderer.centreOf(grain));
    showTip(this.tip, this.canvas, event, lines);
  }

  private onWheel(event: WheelEvent): void {
    if (!event.ctrlKey) return; // the page scrolls
    event.preventDefault();
    this.zoom(Math.exp(-0.01 * event.deltaY), event.offsetX, event.offsetY);
  }

  private onTouch(event: TouchEvent): void {
    event.preventDefault();
    const { left, top } = this.canvas.getBoundingClientRect();
    const touches = [...event.touches].slice(0, 2);
    const mean = (get: (touch: Touch) => number) => touches.reduce((s, t) => s + get(t), 0) / touches.length;
    const [x, y] = [mean((t) => t.clientX) - left, mean((t) => t.clientY) - top];
    const count = touches.length;
    const [a, b] = [touches[0], touches[count - 1]];
    const distance = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY) || 1;
    const before = this.fingers;
    this.fingers = { x, y, distance, count };
    if (!before || before.count !== count) return;
    if (count === 1)
      this.renderer.camera.turn(-DEGREES_A_PIXEL * (x - before.x), DEGREES_A_PIXEL * (y - before.y));
    else {
      this.pan(x - before.x, y - before.y);
      this.zoom(distance / before.distance, x, y);
    }
    this.tip.hidden = true;
    this.changed(-1);
  }

  private pan(dx: number, dy: number): void {
    const s = this.renderer.pixelsPerMetre;
    this.renderer.camera.pan(dx / s, -dy / s);
  }

  private zoom(factor: number, x: number, y: number): void {
    this.renderer.camera.zoomAt(factor, this.renderer.toPicture(x, y));
    this.changed(-1);
  }

  private leave(): void {
    this.tip.hidden = true;
    this.changed(-1);
  }
}
