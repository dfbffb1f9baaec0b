// The worker: the solver's module, and the loop over its steps. It never waits for the page, nor the page for it: one
// picture at a time is under way.
import { FromSolver, Numbers, NUMBERS, Picture, ToSolver } from "./messages";

interface Module {
  memory: WebAssembly.Memory;
  malloc(bytes: number): number;
  free(place: number): void;
  _initialize(): void;
  live_begin(text: number): number;
  live_start_height(): number;
  live_drive_to(height: number): void;
  live_step(): number;
  live_array(which: number, size: number): number;
}

const port = self as unknown as {
  postMessage(message: FromSolver, transfer?: Transferable[]): void;
  addEventListener(type: "message", listener: (event: MessageEvent<ToSolver>) => void): void;
};

/** Longest time without a look at the messages [ms]. */
const TURN = 12;
/** Steps after which grains under a wall that rests are left alone. */
const STEPS_TO_REST = 300;

let module: Module;
let size = 0; // a place in the module's memory

/** What the module's C library asks of a system: an empty environment, a clock; it has no files and never exits. */
const system = {
  environ_sizes_get(count: number, bytes: number): number {
    const memory = new DataView(module.memory.buffer);
    memory.setUint32(count, 0, true);
    memory.setUint32(bytes, 0, true);
    return 0;
  },
  environ_get: () => 0,
  clock_time_get(_clock: number, _precision: bigint, time: number): number {
    new DataView(module.memory.buffer).setBigUint64(time, BigInt(Math.round(1e6 * performance.now())), true);
    return 0;
  },
  fd_write: () => 8, // no such file
  fd_close: () => 8,
  fd_seek: () => 8,
  proc_exit(): never {
    throw new Error("the solver has stopped");
  },
};

async function load(bytes: ArrayBuffer): Promise<void> {
  const { instance } = await WebAssembly.instantiate(bytes, {
    env: { emscripten_notify_memory_growth: () => undefined },
    wasi_snapshot_preview1: system,
  });
  module = instance.exports as unknown as Module;
  module._initialize();
  size = module.malloc(4);
}

function textAt(place: number): string {
  const bytes = new Uint8Array(module.memory.buffer, place);
  return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
}

function begin(text: string): string {
  const bytes = new TextEncoder().encode(text + "\0");
  const place = module.malloc(bytes.length);
  new Uint8Array(module.memory.buffer).set(bytes, place);
  const words = textAt(module.live_begin(place));
  module.free(place);
  return words;
}

/** A copy of an array of the picture. */
function arrayOf<T>(which: number, make: (memory: ArrayBuffer, place: number, count: number) => T): T {
  const place = module.live_array(which, size);
  return make(module.memory.buffer, place, new Int32Array(module.memory.buffer, size, 1)[0]);
}
const floats = (memory: ArrayBuffer, place: number, count: number) =>
  new Float32Array(memory, place, count).slice();

function picture(): Picture {
  const numbers = arrayOf(0, (memory, place, count) => new Float64Array(memory, place, count).slice());
  return {
    numbers: Object.fromEntries(NUMBERS.map((name, k) => [name, numbers[k]])) as Numbers,
    outline: arrayOf(1, floats),
    outlineBegin: arrayOf(2, (memory, place, count) => new Int32Array(memory, place, count).slice()),
    disks: arrayOf(3, floats),
    pressure: arrayOf(4, floats),
    chains: arrayOf(5, floats),
  };
}

class Loop {
  private pace = 60;
  private goal = 0;
  private height = 0;
  private paused = false;
  private begun = false; // there is a simulation: before it a call into the module would follow null
  private over = false;
  private underWay = false; // a picture
  private changed = false; // since the last picture
  private scheduled = false;
  private resting = 0; // steps since the top wall came to rest
  private due = 0; // when the next step may be made [ms]
  private spent = { seconds: 0, steps: 0 };
  private wake = new MessageChannel();

  constructor() {
    this.wake.port1.onmessage = () => this.turn();
  }

  begin(text: string, pace: number): void {
    this.begun = false;
    const words = begin(text);
    this.begun = words === "";
    this.over = words !== "";
    this.changed = this.underWay = false;
    if (this.over) return port.postMessage({ kind: "over", words });
    this.pace = pace;
    this.goal = this.height = module.live_start_height();
    this.resting = STEPS_TO_REST;
    this.paused = false;
    this.spent = { seconds: 0, steps: 0 };
    port.postMessage({ kind: "began", height: this.height });
    this.send();
  }

  drive(height: number): void {
    if (!this.begun || this.over) return;
    this.goal = height;
    module.live_drive_to(height);
    this.resting = 0;
    this.schedule();
  }

  pause(paused: boolean): void {
    this.paused = paused;
    this.schedule();
  }

  drawn(): void {
    this.underWay = false;
    if (this.changed) this.send();
  }

  steps(count: number): void {
    if (!this.begun) return;
    for (let k = 0; k < count && !this.over; ++k) this.step();
    this.send();
  }

  private get idle(): boolean {
    return !this.begun || this.paused || this.over || this.resting >= STEPS_TO_REST;
  }

  private schedule(): void {
    if (this.scheduled || this.idle) return;
    this.scheduled = true;
    const wait = this.due - performance.now();
    if (wait > 2) setTimeout(() => this.turn(), wait);
    else this.wake.port2.postMessage(0);
  }

  private turn(): void {
    this.scheduled = false;
    const end = performance.now() + TURN;
    for (let now = end - TURN; now < end && now >= this.due - 1 && !this.idle; now = performance.now()) {
      this.due = Math.max(this.due, now - 50) + 1000 / this.pace;
      this.step();
    }
    if (this.changed && !this.underWay) this.send();
    this.schedule();
  }

  private step(): void {
    const start = performance.now();
    const words = textAt(module.live_step());
    this.spent.seconds += (performance.now() - start) / 1000;
    this.spent.steps += 1;
    this.changed = true;
    this.resting = Math.abs(this.height - this.goal) < 1e-9 ? this.resting + 1 : 0;
    if (words === "") return;
    this.over = true;
    port.postMessage({ kind: "over", words });
  }

  private send(): void {
    const drawn = picture();
    this.height = drawn.numbers.height;
    this.underWay = true;
    this.changed = false;
    const { seconds, steps } = this.spent;
    this.spent = { seconds: 0, steps: 0 };
    const transfer = [drawn.outline, drawn.outlineBegin, drawn.disks, drawn.pressure, drawn.chains];
    port.postMessage(
      {
        kind: "picture",
        picture: drawn,
        secondsPerStep: steps > 0 ? seconds / steps : 0,
        resting: this.idle,
      },
      transfer.map((array) => array.buffer as ArrayBuffer),
    );
  }
}

const loop = new Loop();
port.addEventListener("message", ({ data }) => {
  if (data.kind === "module")
    load(data.bytes).then(
      () => port.postMessage({ kind: "ready" }),
      (error: Error) => port.postMessage({ kind: "over", words: error.message }),
    );
  else if (data.kind === "begin") loop.begin(data.text, data.pace);
  else if (data.kind === "drive") loop.drive(data.height);
  else if (data.kind === "pause") loop.pause(data.paused);
  else if (data.kind === "drawn") loop.drawn();
  else loop.steps(data.count);
});
