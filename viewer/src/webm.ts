import { Film, joined, text, whole } from "./container";

/** Identifier, size in eight bytes, content. */
function element(id: number, ...parts: Uint8Array[]): Uint8Array {
  const content = joined(parts);
  const bytes = Math.ceil(Math.log2(id + 1) / 8);
  return joined([whole(id, bytes), whole(1, 1), whole(content.length, 7), content]);
}
/** All numbers have eight bytes, so that sizes do not depend on them. */
const number = (id: number, value: number) => element(id, whole(value, 8));

function real(id: number, value: number): Uint8Array {
  const bytes = new Uint8Array(8);
  new DataView(bytes.buffer).setFloat64(0, value);
  return element(id, bytes);
}

/** One track of VP8 as a WebM file: https://www.webmproject.org/docs/container. Each key picture begins a cluster. */
export function webmOf(film: Film): Uint8Array<ArrayBuffer> {
  const ends = film.seconds.reduce((all, seconds) => [...all, all.at(-1)! + 1000 * seconds], [0]); // [ms]
  const head = element(
    0x1a45dfa3,
    ...[number(0x4286, 1), number(0x42f7, 1), number(0x42f2, 4), number(0x42f3, 8)],
    ...[element(0x4282, text("webm")), number(0x4287, 2), number(0x4285, 2)],
  );
  const info = element(
    0x1549a966,
    ...[number(0x2ad7b1, 1_000_000), real(0x4489, ends.at(-1)!)],
    ...[element(0x4d80, text("softgrain")), element(0x5741, text("softgrain"))],
  );
  const video = element(0xe0, number(0xb0, film.width), number(0xba, film.height));
  const codec = element(0x86, text("V_VP8"));
  const track = element(0xae, number(0xd7, 1), number(0x73c5, 1), number(0x83, 1), codec, video);
  const tracks = element(0x1654ae6b, track);
  const keys = film.pictures.flatMap(({ key }, k) => (key ? [k] : []));
  const clusters = keys.map((key, k) => clusterOf(film, ends, key, keys[k + 1] ?? film.pictures.length));
  const cues = (places: number[]) =>
    element(
      0x1c53bb6b,
      ...keys.map((key, k) => {
        const position = element(0xb7, number(0xf7, 1), number(0xf1, places[k]));
        return element(0xbb, number(0xb3, Math.round(ends[key])), position);
      }),
    );
  let at = info.length + tracks.length + cues(keys).length;
  const places = clusters.map((cluster) => (at += cluster.length) - cluster.length);
  return joined([head, element(0x18538067, info, tracks, cues(places), ...clusters)]);
}

/** Pictures begin .. end - 1, with their times after the first. */
function clusterOf(film: Film, ends: number[], begin: number, end: number): Uint8Array {
  const start = Math.round(ends[begin]);
  const blocks = film.pictures.slice(begin, end).map(({ data, key }, k) => {
    const after = whole(Math.round(ends[begin + k]) - start, 2);
    return element(0xa3, whole(0x81, 1), after, whole(key ? 0x80 : 0, 1), data);
  });
  return element(0x1f43b675, number(0xe7, start), ...blocks);
}
