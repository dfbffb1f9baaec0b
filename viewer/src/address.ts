// What a reader has chosen, as it stands in the address after "#": who copies the address shows others the same.

export interface View {
  run: number;
  frame: number;
  colour: string;
  over: string;
  /** Ends of the colours that were typed [SI]; "" for none. */
  low: string;
  high: string;
  /** Whether colours run over powers of ten. */
  log: boolean;
  chains: boolean;
  /** In space: from where one looks, and where the packing is cut. */
  camera: string;
  cut: string;
  /** Of each plot "x,y", or "x,y,log". */
  plots: string[];
}

/** What differs from the view at the opening: "frame=3&colour=J&log=1". */
export function toHash(view: View, first: View): string {
  const words = new URLSearchParams();
  for (const key of Object.keys(first) as (keyof View)[]) {
    const [now, then] = [view[key], first[key]].map((value) => textOf(value));
    if (now !== then) words.set(key, now);
  }
  return words.toString().replaceAll("%2C", ",").replaceAll("%3B", ";");
}

/** Of an address; what it does not say, or what cannot be, is as at the opening. */
export function fromHash(hash: string, first: View): View {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const whole = (name: "run" | "frame") => {
    const value = Number(given.get(name) ?? first[name]);
    return Number.isInteger(value) && value >= 0 ? value : first[name];
  };
  const word = (name: "colour" | "over" | "low" | "high" | "camera" | "cut") =>
    given.get(name) ?? first[name];
  const mark = (name: "log" | "chains") => (given.get(name) ?? textOf(first[name])) === "1";
  return {
    run: whole("run"),
    frame: whole("frame"),
    colour: word("colour"),
    over: word("over"),
    low: word("low"),
    high: word("high"),
    log: mark("log"),
    chains: mark("chains"),
    camera: word("camera"),
    cut: word("cut"),
    plots: given.get("plots")?.split(";") ?? first.plots,
  };
}

function textOf(value: View[keyof View]): string {
  return Array.isArray(value)
    ? value.join(";")
    : typeof value === "boolean"
      ? value
        ? "1"
        : "0"
      : String(value);
}
