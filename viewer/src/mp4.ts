import { Film, joined, text, whole } from "./container";

/** Ticks a second. */
const TICKS = 90_000;
const MATRIX = [0x10000, 0, 0, 0, 0x10000, 0, 0, 0, 0x40000000]; // nothing is turned

const u16 = (...values: number[]) => joined(values.map((value) => whole(value, 2)));
const u32 = (...values: number[]) => joined(values.map((value) => whole(value, 4)));

function box(type: string, ...parts: Uint8Array[]): Uint8Array {
  const content = joined(parts);
  return joined([u32(8 + content.length), text(type), content]);
}
/** With version 0 and flags. */
const full = (type: string, flags: number, ...parts: Uint8Array[]) => box(type, u32(flags), ...parts);

/** One track of H.264 as an MP4 file, ISO/IEC 14496-12 and -15: what is where stands before the pictures. */
export function mp4Of(film: Film): Uint8Array<ArrayBuffer> {
  const head = box("ftyp", text("isom"), u32(512), text("isomiso2avc1mp41"));
  const first = head.length + moov(film, 0).length + 8;
  return joined([head, moov(film, first), box("mdat", ...film.pictures.map(({ data }) => data))]);
}

/** `first`: where the first picture begins. */
function moov(film: Film, first: number): Uint8Array {
  const ticks = film.seconds.map((seconds) => Math.round(TICKS * seconds));
  const duration = ticks.reduce((sum, length) => sum + length, 0);
  const size = u32(film.width * 65536, film.height * 65536);
  const times = u32(0, 0, TICKS, duration);
  const mvhd = full("mvhd", 0, times, u32(0x10000), u16(0x100, 0), u32(0, 0, ...MATRIX, 0, 0, 0, 0, 0, 0, 2));
  const tkhd = full("tkhd", 3, u32(0, 0, 1, 0, duration, 0, 0), u16(0, 0, 0, 0), u32(...MATRIX), size);
  const mdhd = full("mdhd", 0, times, u16(0x55c4, 0));
  const hdlr = full("hdlr", 0, u32(0), text("vide"), u32(0, 0, 0), text("pictures\0"));
  const dinf = box("dinf", full("dref", 0, u32(1), full("url ", 1)));
  const minf = box("minf", full("vmhd", 1, u16(0, 0, 0, 0)), dinf, samples(film, ticks, first));
  return box("moov", mvhd, box("trak", tkhd, box("mdia", mdhd, hdlr, minf)));
}

/** Tables of the pictures, all of them in one chunk. */
function samples(film: Film, ticks: number[], first: number): Uint8Array {
  const keys = film.pictures.flatMap(({ key }, k) => (key ? [k + 1] : []));
  const count = ticks.length;
  return box(
    "stbl",
    full("stsd", 0, u32(1), avc1(film)),
    full("stts", 0, u32(count), ...ticks.map((length) => u32(1, length))),
    full("stss", 0, u32(keys.length, ...keys)),
    full("stsc", 0, u32(1, 1, count, 1)),
    full("stsz", 0, u32(0, count, ...film.pictures.map(({ data }) => data.length))),
    full("stco", 0, u32(1, first)),
  );
}

function avc1({ width, height, description }: Film): Uint8Array {
  const resolution = u32(0x480000, 0x480000, 0);
  const begin = [u16(0, 0, 0, 1), new Uint8Array(16), u16(width, height), resolution, u16(1)];
  return box("avc1", ...begin, new Uint8Array(32), u16(24, 0xffff), box("avcC", description));
}
