import { Colouring } from "./colouring";
import { colourAt, css } from "./colours";
import { scaleFor, short } from "./units";

interface Picture {
  /** Draws the canvas anew with this many pixels for one of CSS. */
  draw(ratio: number): void;
  colouring: Colouring | null;
  /** Below it. */
  words: string;
  /** Of the file. */
  name: string;
}

const WIDTH = 2000; // of the file [pixels]

/** A PNG of the canvas with a caption and the scale of its colours, on the page's ground. */
export function savePicture(canvas: HTMLCanvasElement, picture: Picture): void {
  const ratio = WIDTH / canvas.clientWidth;
  picture.draw(ratio);
  const file = document.createElement("canvas");
  file.width = canvas.width;
  file.height = canvas.height + Math.round(0.06 * WIDTH);
  const pen = file.getContext("2d")!;
  const style = getComputedStyle(canvas.closest(".packing") ?? canvas);
  pen.fillStyle = style.backgroundColor;
  pen.fillRect(0, 0, file.width, file.height);
  pen.drawImage(canvas, 0, 0); // in the same turn: the browser forgets what WebGL drew after it
  const size = 0.014 * WIDTH;
  pen.font = `${size}px system-ui, sans-serif`;
  pen.fillStyle = style.color;
  pen.fillText(picture.words, size, canvas.height + 2 * size);
  if (picture.colouring) drawScale(pen, picture.colouring, canvas.height, size);
  file.toBlob((blob) => {
    if (!blob) return;
    const link = document.createElement("a");
    link.download = picture.name;
    link.href = URL.createObjectURL(blob);
    link.click();
    URL.revokeObjectURL(link.href);
  });
}

/** At the right. */
function drawScale(pen: CanvasRenderingContext2D, colouring: Colouring, top: number, size: number): void {
  const { map, low, high, label, unit } = colouring;
  if (map === "categories") return;
  const scale = scaleFor(Math.max(Math.abs(low), Math.abs(high)), unit);
  const [width, right] = [0.3 * WIDTH, WIDTH - size];
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
