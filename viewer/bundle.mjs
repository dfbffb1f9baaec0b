// What both pages are built with: src/ (the page of a run) and live/src/ (the live page).
import { build } from "esbuild";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { dirname } from "node:path";
import { fileURLToPath } from "node:url";

export const here = (path) => fileURLToPath(new URL(path, import.meta.url));

/** A script or style sheet with all that it imports, as one text. */
export async function bundle(entry) {
  const result = await build({
    entryPoints: [here(entry)],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2022",
    charset: "utf8",
    legalComments: "none",
  });
  const text = result.outputFiles[0].text.trim();
  if (text.includes("</script") || text.includes("<!--")) throw new Error(`${entry} would end its own tag`);
  return text;
}

/** A page with its parts put in the places of their names, between slashes and stars. */
export async function writePage(template, parts, output) {
  parts.license = (await readFile(here("node_modules/uplot/LICENSE"), "utf8")).trim();
  let html = await readFile(here(template), "utf8");
  // As functions, because $ has a meaning in a replacement.
  for (const [name, text] of Object.entries(parts)) html = html.replace(`/*${name}*/`, () => text);
  await mkdir(dirname(output), { recursive: true });
  await writeFile(output, html);
}
