// What page and solver say to each other.

/** Names of Picture.numbers, as live_numbers() in solver/live_simulation.cpp. */
export const NUMBERS = [
  "step",
  "time",
  "strain",
  "height",
  "width",
  "phi_0",
  "phi",
  "z",
  "stress",
  "kinetic",
] as const;
export type Numbers = Record<(typeof NUMBERS)[number], number>;

/** LivePicture of solver/live_simulation.hpp. */
export interface Picture {
  numbers: Numbers;
  outline: Float32Array;
  outlineBegin: Int32Array;
  disks: Float32Array;
  pressure: Float32Array;
  chains: Float32Array;
}

export type ToSolver =
  | { kind: "module"; bytes: ArrayBuffer }
  /** A new simulation, which rests until it is driven; at most so many steps a second. */
  | { kind: "begin"; text: string; pace: number }
  /** Where the top wall shall go [m above the bottom]. */
  | { kind: "drive"; height: number }
  | { kind: "pause"; paused: boolean }
  /** The last picture was drawn, or is about to be; another may come. */
  | { kind: "drawn" }
  /** So many steps at once, however long that takes, then a picture. */
  | { kind: "steps"; count: number };

export type FromSolver =
  | { kind: "ready" }
  | { kind: "began"; height: number }
  | {
      kind: "picture";
      picture: Picture;
      /** Mean time of a step since the picture before [s]; 0: none was made. */
      secondsPerStep: number;
      resting: boolean;
    }
  /** No further step: what is wrong, or why it is over. */
  | { kind: "over"; words: string };
