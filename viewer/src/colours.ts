// Perceptual colour maps, each as 17 colours between which we interpolate (from Matplotlib).
const MAPS = {
  viridis:
    "44015448186a472d7b4240863b528b33638d2c728e26828e21918c1fa08828ae803fbc735ec96284d44baddc30d8e219fde725",
  cividis:
    "00224e002e6a1a386f32436d434e6c535a6d61656f6f70737d7c788c88789b9476aba072bcae6ccdbb63dec958f0d846fee838",
  PuOr: "2d004b4518715f3a917b6aa89990bfb7b1d5cfcfe5e4e5f0f7f7f6fce8cdfed59ffdbc6bee9b39d97b12bd61099e4c077f3b08",
};
export type MapName = keyof typeof MAPS;
export type Rgb = [number, number, number];

/** The colour at s in [0, 1], outside of it at the nearer end; 0 to 255. */
export function colourAt(map: MapName, s: number): Rgb {
  const place = 16 * Math.min(1, Math.max(0, Number.isFinite(s) ? s : 0));
  const k = Math.min(15, Math.floor(place));
  const digit = (at: number) => parseInt(MAPS[map].slice(2 * at, 2 * at + 2), 16);
  const channel = (c: number) => digit(3 * k + c) * (1 - place + k) + digit(3 * k + 3 + c) * (place - k);
  return [channel(0), channel(1), channel(2)];
}

/** Neighbouring numbers get unlike colours, all of about one lightness. */
export function categoryColour(index: number): Rgb {
  const hue = (index * 137.508) % 360;
  const channel = (n: number) => {
    const k = (n + hue / 30) % 12;
    return 255 * (0.6 - 0.22 * Math.max(-1, Math.min(k - 3, 9 - k, 1)));
  };
  return [channel(0), channel(8), channel(4)];
}

/** For curves of several runs: distinct for the colour-blind, on light and on dark. */
export const RUN_COLOURS = [
  "#3b7dd8",
  "#e07b26",
  "#2a9d72",
  "#b05cc6",
  "#c8991a",
  "#d1495b",
  "#5c6f82",
  "#2aa6b8",
];
export const runColour = (index: number): string => RUN_COLOURS[index % RUN_COLOURS.length];

export function css([r, g, b]: Rgb): string {
  return `rgb(${Math.round(r)},${Math.round(g)},${Math.round(b)})`;
}

export function gradient(map: MapName): string {
  const stops = Array.from({ length: 17 }, (_, k) => css(colourAt(map, k / 16)));
  return `linear-gradient(to right, ${stops.join(",")})`;
}
