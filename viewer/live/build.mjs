// Bundles live/src/ and the solver's module into one file: node live/build.mjs MODULE.wasm PAGE.html
import { readFile } from "node:fs/promises";
import { gzipSync } from "node:zlib";
import { bundle, writePage } from "../bundle.mjs";

const [module, output] = process.argv.slice(2);
const [script, solver, style] = await Promise.all(
  ["main.ts", "solver.ts", "style.css"].map((name) => bundle(`live/src/${name}`)),
);
const packed = gzipSync(await readFile(module), { level: 9 }).toString("base64");
await writePage("live/src/page.html", { style, module: packed, solver, script }, output);
