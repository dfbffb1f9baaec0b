import { Colouring, middleOf } from "./colouring";
import { categoryColour, css, gradient, Rgb } from "./colours";
import { ForceScale } from "./picture";
import { scaleFor, short, withUnit } from "./units";

/**
 * A bar with its ends and unit; squares where the colour only tells grains apart. The ends can be typed over:
 * `take` gets what was typed, in SI, or nothing where the field was emptied.
 */
export function showLegend(
  parent: HTMLElement,
  colouring: Colouring | null,
  take: (end: "low" | "high", value?: number) => void,
): void {
  if (parent.contains(document.activeElement)) return; // somebody types
  parent.replaceChildren();
  if (!colouring) return;
  const { low, high, label, unit, map } = colouring;
  const bar = document.createElement("div");
  if (map === "categories") {
    bar.className = "squares";
    for (let k = 0; k < 12; ++k) {
      const square = document.createElement("i");
      square.style.background = css(categoryColour(k));
      bar.append(square);
    }
    parent.append(text("a colour for each grain"), bar);
    return;
  }
  const scale = scaleFor(Math.max(Math.abs(low), Math.abs(high)), unit);
  bar.className = "bar";
  bar.style.background = gradient(map);
  const ticks = document.createElement("div");
  ticks.className = "ticks";
  const end = (which: "low" | "high", value: number) => {
    const input = document.createElement("input");
    input.type = "text";
    input.inputMode = "decimal";
    input.value = short(scale.factor * value);
    input.ariaLabel = `${which === "low" ? "Lower" : "Upper"} end of the colours`;
    input.title = "Type a number; empty: the run's own";
    input.addEventListener("change", () => {
      const typed = Number(input.value.replace("−", "-").replace(",", "."));
      input.blur();
      take(which, input.value.trim() === "" || !Number.isFinite(typed) ? undefined : typed / scale.factor);
    });
    return input;
  };
  ticks.append(end("low", low), text(short(scale.factor * middleOf(colouring))), end("high", high));
  parent.append(text(scale.unit ? `${label} [${scale.unit}]` : label), bar, ticks);
}

/** A line as wide as the force that stands beside it. */
export function showForceKey(
  parent: HTMLElement,
  scale: ForceScale | null,
  pixelsPerMetre: number,
  colour: Rgb,
  unit: string,
): void {
  parent.replaceChildren();
  if (!scale) return;
  const force = Number((scale.force / 2).toPrecision(1));
  const line = document.createElement("i");
  line.style.background = css(colour);
  line.style.height = `${Math.max(1, (scale.width * pixelsPerMetre * force) / scale.force)}px`;
  parent.append(line, text(`contact force ${withUnit(force, unit)}`));
}

function text(words: string): HTMLElement {
  const span = document.createElement("span");
  span.textContent = words;
  return span;
}
