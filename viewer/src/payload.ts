// What `softgrain report` put into the page: one <script class="run"> for each run, base64 of gzip of
//   size of the header (32 bit, little endian), JSON header, planes of all arrays.

/** value = low + step q, q in `bytes` bytes; coded against the number `stride` before, in planes. */
export interface ArrayInfo {
  name: string;
  low: number;
  step: number;
  bytes: 1 | 2 | 4;
  count: number;
  stride: number;
  /** 1 where the same holds for all. */
  frames: number;
}

/** run.json, as far as the page uses it. */
export interface Provenance {
  state: string;
  message?: string;
  verdict?: string;
  command?: string[];
  started?: string;
  updated?: string;
  seed?: number;
  wall_seconds?: number;
  program?: { version: string; commit: string; compiler: string; flags: string };
  machine?: { cpu: string; threads: number };
}

/** What a particle carries: a column `particle.NAME`, and `grain.NAME` for the mean over a grain. */
export interface Field {
  name: string;
  label: string;
  unit: string;
}

export interface Header {
  name: string;
  run: Provenance;
  case: string;
  /** The resolved case: tables of keys. */
  settings: Record<string, Record<string, unknown>>;
  fields: Field[];
  series: string;
  rows_every: number;
  snapshots_every: number;
  points_merged: number;
  damaged: number;
  contacts_of_grains: boolean;
  steps: number[];
  times: number[];
  /** Number of contacts in each frame. */
  contacts: number[];
  arrays: ArrayInfo[];
}

export interface Payload {
  header: Header;
  planes: Uint8Array;
}

/** Reads and removes the runs of this page. */
export async function takePayloads(): Promise<Payload[]> {
  const scripts = [...document.querySelectorAll<HTMLScriptElement>("script.run")];
  const texts = scripts.map((script) => {
    script.remove();
    return script.textContent ?? "";
  });
  return Promise.all(texts.map(async (text) => unpack(await gunzip(bytesOfBase64(text)))));
}

function bytesOfBase64(text: string): Uint8Array<ArrayBuffer> {
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

async function gunzip(bytes: Uint8Array<ArrayBuffer>): Promise<ArrayBuffer> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

function unpack(buffer: ArrayBuffer): Payload {
  const size = new DataView(buffer).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, size))) as Header;
  return { header, planes: new Uint8Array(buffer, 4 + size) };
}

export type Whole = Uint8Array | Uint16Array | Uint32Array;

/** The whole numbers q of one array, whose planes begin at `begin`. */
export function decodeWhole(planes: Uint8Array, begin: number, info: ArrayInfo): Whole {
  const { count, stride, bytes } = info;
  const q =
    bytes === 1 ? new Uint8Array(count) : bytes === 2 ? new Uint16Array(count) : new Uint32Array(count);
  for (let i = 0; i < count; ++i) {
    let code = 0;
    for (let plane = bytes - 1; plane >= 0; --plane) code = (code << 8) | planes[begin + plane * count + i];
    const difference = (code >>> 1) ^ -(code & 1);
    q[i] = difference + (i < stride ? 0 : q[i - stride]); // modulo the width of the array's type
  }
  return q;
}
