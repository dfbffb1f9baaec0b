import { Colouring } from "./colouring";
import { ForceScale } from "./picture";
import { Run } from "./run";

export interface Look {
  colouring: Colouring | null;
  chains: boolean;
  /** Grain under the pointer; -1 for none. */
  highlight: number;
}

/** Draws runs of one dimension on the canvas. */
export interface Drawing {
  forceScale: ForceScale | null;
  /** Width over height of the whole picture. */
  readonly aspect: number;
  /** CSS pixels per metre. */
  readonly pixelsPerMetre: number;
  show(run: Run): void;
  /** With `ratio` pixels for one of CSS. */
  draw(frame: number, look: Look, ratio?: number): void;
}

/** The colour of text here, 0 to 1. */
export function inkOf(element: Element): number[] {
  const channels = getComputedStyle(element).color.match(/[\d.]+/g) ?? ["0", "0", "0"];
  return channels.slice(0, 3).map((c) => Number(c) / 255);
}
