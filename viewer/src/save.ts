import { Colouring } from "./colouring";
import { colourAt, css } from "./colours";
import { scaleFor, short } from "./units";

export interface Picture {
  /** Draws the canvas anew with this many pixels for one of CSS. */
  draw(ratio: number): void;
  colouring: Colouring | null;
  /** Below it. */
  words: string;
}

const WIDTH = 2000; // of the file [pixels]

/** A PNG of the canvas. */
export function savePicture(canvas: HTMLCanvasElement, picture: Picture, name: string): void {
  const file = document.createElement("canvas");
  compose(file, canvas, picture, WIDTH);
  file.toBlob((blob) => blob && download(blob, name));
}

/** Draws the canvas into `file`, with a caption and the scale of its colours, on the page's ground. */
export function compose(
  file: HTMLCanvasElement,
  canvas: HTMLCanvasElement,
  picture: Picture,
  width: number,
): void {
  picture.draw(width / canvas.clientWidth);
  const height = 2 * Math.ceil(canvas.height / 2 + 0.03 * width); // even, as films must be
  if (file.width !== width || file.height !== height) [file.width, file.height] = [width, height];
  const pen = file.getContext("2d")!;
  const style = getComputedStyle(canvas.closest(".packing") ?? canvas);
  pen.fillStyle = style.backgroundColor;
  pen.fillRect(0, 0, file.width, file.height);
  pen.drawImage(canvas, 0, 0); // in the same turn: the browser forgets what WebGL drew after it
  const size = 0.014 * width;
  pen.font = `${size}px system-ui, sans-serif`;
  pen.fillStyle = style.color;
  pen.textAlign = "left";
  pen.fillText(picture.words, size, canvas.height + 2 * size);
  if (picture.colouring) drawScale(pen, picture.colouring, canvas.height, size);
}

export function download(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.download = name;
  link.href = URL.createObjectURL(blob);
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** At the right. */
function drawScale(pen: CanvasRenderingContext2D, colouring: Colouring, top: number, size: number): void {
  const { map, low, high, label, unit } = colouring;
  if (map === "categories") return;
  const scale = scaleFor(Math.max(Math.abs(low), Math.abs(high)), unit);
  const [width, right] = [0.3 * pen.canvas.width, pen.canvas.width - size];
  const ink = pen.fillStyle;
  for (let k = 0; k < width; ++k) {
    pen.fillStyle = css(colourAt(map, k / width));
    pen.fillRect(right - width + k, top + 0.6 * size, 1, 0.9 * size);
  }
  pen.fillStyle = ink;
  pen.textAlign = "left";
  pen.fillText(short(scale.factor * low), right - width, top + 2.8 * size);
  pen.textAlign = "center";
  pen.fillText(scale.unit ? `${label} [${scale.unit}]` : label, right - width / 2, top + 2.8 * size);
  pen.textAlign = "right";
  pen.fillText(short(scale.factor * high), right, top + 2.8 * size);
}
