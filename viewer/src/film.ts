import { compose, download, Picture } from "./save";

/** What browsers write, those first that most players open. */
const TYPES: [type: string, ending: string][] = [
  ["video/mp4;codecs=avc1.64001f", "mp4"],
  ["video/mp4;codecs=avc1.42e01f", "mp4"],
  ["video/webm;codecs=vp9", "webm"],
  ["video/webm;codecs=vp8", "webm"],
];
const WIDTH = 1280; // [pixels]
const BITS = 8e6; // a second
/** How long the last picture stands [s]. */
const END = 1;

/** The type of films that this browser can write, and the ending of their names; null: none. */
export function filmType(): [type: string, ending: string] | null {
  if (typeof MediaRecorder === "undefined" || !HTMLCanvasElement.prototype.captureStream) return null;
  return TYPES.find(([type]) => MediaRecorder.isTypeSupported(type)) ?? null;
}

interface Film {
  frames: number;
  perSecond: number;
  /** Of a frame; called before it is drawn. */
  picture(frame: number): Picture;
  /** Of the file, without its ending. */
  name: string;
  /** Whether to end here. */
  stopped(): boolean;
}

/** Plays all frames into a film and saves it. It takes as long as the film: the browser records what passes by. */
export async function saveFilm(canvas: HTMLCanvasElement, film: Film): Promise<void> {
  const [type, ending] = filmType()!;
  const file = document.createElement("canvas");
  compose(file, canvas, film.picture(0), WIDTH);
  const recorder = new MediaRecorder(file.captureStream(), { mimeType: type, videoBitsPerSecond: BITS });
  const parts: Blob[] = [];
  recorder.ondataavailable = ({ data }) => parts.push(data);
  const ended = new Promise((done) => (recorder.onstop = done));
  recorder.start();
  const begin = performance.now();
  for (let frame = 0; frame < film.frames && !film.stopped(); ++frame) {
    compose(file, canvas, film.picture(frame), WIDTH);
    await until(begin + (1000 * (frame + 1)) / film.perSecond);
  }
  const last = performance.now();
  while (performance.now() < last + 1000 * END) {
    file.getContext("2d")!.fillRect(0, 0, 0, 0); // the same picture, as a new frame
    await until(performance.now() + 100);
  }
  recorder.stop();
  await ended;
  download(new Blob(parts, { type: type.split(";")[0] }), `${film.name}.${ending}`);
}

/** A moment of performance.now(), or the next turn where that has passed. */
const until = (moment: number) =>
  new Promise((done) => setTimeout(done, Math.max(0, moment - performance.now())));
