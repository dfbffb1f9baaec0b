// Pieces that containers of films are made of: numbers with the largest byte first, and bytes one after the other.

/** What an encoder has made of a film. */
export interface Film {
  width: number;
  height: number;
  /** How long each picture stands [s]. */
  seconds: number[];
  pictures: { data: Uint8Array; key: boolean }[];
  /** What a decoder must know first; avc1 has some. */
  description: Uint8Array;
}

export function joined(parts: Uint8Array[]): Uint8Array<ArrayBuffer> {
  const all = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

/** A whole number in so many bytes. */
export function whole(value: number, bytes: number): Uint8Array {
  return Uint8Array.from({ length: bytes }, (_, k) => Math.floor(value / 256 ** (bytes - 1 - k)) % 256);
}

export const text = (words: string): Uint8Array => new TextEncoder().encode(words);
