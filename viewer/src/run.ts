import { ArrayInfo, decodeWhole, Header, Payload, Whole } from "./payload";
import { parseSeries, Series } from "./series";

/** A column of numbers in every frame; decoded when first asked for. */
class Column {
  private q?: Whole;

  constructor(
    private planes: Uint8Array,
    private begin: number,
    private info: ArrayInfo,
  ) {}

  slice(begin: number, end: number): Float32Array {
    this.q ??= decodeWhole(this.planes, this.begin, this.info);
    const { low, step } = this.info;
    const values = new Float32Array(end - begin);
    for (let i = begin; i < end; ++i) values[i - begin] = low + step * this.q[i];
    return values;
  }

  frame(k: number): Float32Array {
    const length = this.info.count / this.info.frames;
    const begin = this.info.frames === 1 ? 0 : k * length;
    return this.slice(begin, begin + length);
  }
}

const nothing = new Float32Array(0);

export interface Contacts {
  a: Float32Array;
  b: Float32Array;
  /** [N/m], in space [N] */
  force: Float32Array;
}

/** One run: its series, and its frames (pictures at the times of snapshots). SI units. */
export class Run {
  readonly header: Header;
  readonly series: Series;
  /** Grain g's outline has the vertices outlineBegin[g] .. outlineBegin[g + 1] - 1. */
  readonly outlineBegin: number[];
  readonly grains: number;
  private columns = new Map<string, Column>();
  private contactBegin = [0];

  constructor({ header, planes }: Payload) {
    this.header = header;
    this.series = parseSeries(header.series);
    let begin = 0;
    for (const info of header.arrays) {
      this.columns.set(info.name, new Column(planes, begin, info));
      begin += info.bytes * info.count;
    }
    for (const count of header.contacts) this.contactBegin.push(this.contactBegin.at(-1)! + count);
    this.grains = this.column("grain.x", 0).length;
    this.outlineBegin = this.begins();
  }

  get name(): string {
    return this.header.name;
  }
  get frames(): number {
    return this.header.times.length;
  }
  get hasOutlines(): boolean {
    return this.has("outline.x") && this.outlineBegin.length > 1;
  }
  get inSpace(): boolean {
    return this.has("vertex.x");
  }
  has(name: string): boolean {
    return this.columns.has(name);
  }

  /** The values of a column in a frame; none where the run does not have it. */
  column(name: string, frame: number): Float32Array {
    return this.columns.get(name)?.frame(frame) ?? nothing;
  }

  contacts(frame: number): Contacts {
    const [begin, end] = [this.contactBegin[frame], this.contactBegin[frame + 1]];
    const get = (name: string) => this.columns.get(name)?.slice(begin, end) ?? nothing;
    return { a: get("contact.a"), b: get("contact.b"), force: get("contact.force") };
  }

  /** Up to `count` frames, evenly over the run, the first and the last among them: enough for a range. */
  sample(count: number): number[] {
    const last = this.frames - 1;
    const frames = Array.from({ length: count }, (_, k) => Math.round((k * last) / Math.max(1, count - 1)));
    return [...new Set(frames)];
  }

  private begins(): number[] {
    const owner = this.column("outline.grain", 0);
    const begins: number[] = [];
    owner.forEach((grain, vertex) => {
      if (vertex === 0 || grain !== owner[vertex - 1]) begins.push(vertex);
    });
    return [...begins, owner.length];
  }
}
