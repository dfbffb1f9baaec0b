import { Film, joined } from "./container";
import { mp4Of } from "./mp4";
import { compose, download, Picture } from "./save";
import { webmOf } from "./webm";

/** What encoders may know, those first whose files most players open: H.264 of three profiles, VP8. */
const CODECS = ["avc1.640032", "avc1.4d0032", "avc1.420032", "vp8"];
const WIDTH = 1280; // [pixels]
const BITS = 6e6; // a second
/** Pictures from one that stands for itself to the next. */
const KEY_EVERY = 30;
/** How much longer the last picture stands [s]. */
const END = 1;

export const canFilm = (): boolean => typeof VideoEncoder !== "undefined";

export interface Reel {
  frames: number;
  perSecond: number;
  /** Of a frame; called before it is drawn. */
  picture(frame: number): Picture;
  /** Of the file, without its ending. */
  name: string;
  /** Whether to end here. */
  stopped(): boolean;
}

/** Draws all frames into a film and saves it: MP4, or WebM where the browser has no H.264. Throws where it has neither. */
export async function saveFilm(canvas: HTMLCanvasElement, reel: Reel): Promise<void> {
  const file = document.createElement("canvas");
  compose(file, canvas, reel.picture(0), WIDTH);
  const { width, height } = file;
  const config = await configOf(width, height, reel.perSecond);
  const film: Film = { width, height, seconds: [], pictures: [], description: new Uint8Array() };
  let failure: Error | undefined;
  const encoder = new VideoEncoder({
    output: (chunk, about) => {
      const data = new Uint8Array(chunk.byteLength);
      chunk.copyTo(data);
      film.pictures.push({ data, key: chunk.type === "key" });
      const description = about?.decoderConfig?.description;
      if (description) film.description = bytesOf(description);
    },
    error: (error) => (failure = error),
  });
  encoder.configure(config);
  for (let frame = 0; frame < reel.frames && !reel.stopped() && !failure; ++frame) {
    compose(file, canvas, reel.picture(frame), WIDTH);
    const image = new VideoFrame(file, { timestamp: Math.round((1e6 * frame) / reel.perSecond) });
    encoder.encode(image, { keyFrame: frame % KEY_EVERY === 0 });
    image.close();
    do
      await new Promise((done) => setTimeout(done)); // the page lives on
    while (encoder.encodeQueueSize > 3 && !failure);
  }
  if (!failure) await encoder.flush();
  if (failure) throw failure;
  encoder.close();
  const last = film.pictures.length - 1;
  film.seconds = film.pictures.map((_, k) => 1 / reel.perSecond + (k === last ? END : 0));
  const mp4 = config.codec.startsWith("avc1");
  const type = mp4 ? "video/mp4" : "video/webm";
  download(new Blob([mp4 ? mp4Of(film) : webmOf(film)], { type }), `${reel.name}.${mp4 ? "mp4" : "webm"}`);
}

async function configOf(width: number, height: number, framerate: number): Promise<VideoEncoderConfig> {
  for (const codec of CODECS) {
    const config: VideoEncoderConfig = { codec, width, height, framerate, bitrate: BITS };
    if (codec.startsWith("avc1")) config.avc = { format: "avc" };
    if ((await VideoEncoder.isConfigSupported(config)).supported) return config;
  }
  throw new Error("it encodes neither H.264 nor VP8");
}

function bytesOf(source: AllowSharedBufferSource): Uint8Array {
  return ArrayBuffer.isView(source)
    ? joined([new Uint8Array(source.buffer, source.byteOffset, source.byteLength)])
    : joined([new Uint8Array(source)]);
}
