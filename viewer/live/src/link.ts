import { FromSolver, ToSolver } from "./messages";

/** The bytes of the module, which the page carries as gzip in base64. */
async function moduleBytes(): Promise<ArrayBuffer> {
  const text = document.getElementById("module")!.textContent!;
  const packed = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}

/** The worker that computes. `hear` gets what it says. */
export class Link {
  private worker: Worker;

  constructor(hear: (message: FromSolver) => void) {
    const source = document.getElementById("solver")!.textContent!;
    this.worker = new Worker(URL.createObjectURL(new Blob([source], { type: "text/javascript" })));
    this.worker.onmessage = ({ data }: MessageEvent<FromSolver>) => hear(data);
    this.worker.onerror = (event) => hear({ kind: "over", words: event.message || "the solver has stopped" });
    moduleBytes().then(
      (bytes) => this.worker.postMessage({ kind: "module", bytes }, [bytes]),
      (error: Error) => hear({ kind: "over", words: error.message }),
    );
  }

  say(message: ToSolver): void {
    this.worker.postMessage(message);
  }
}
