// Bundles src/ into one file, dist/report_template.html (or the file given). `softgrain report` puts the title
// and the runs in the places of <!--title--> and <!--runs-->.
import { build } from "esbuild";
import { readFile, writeFile, mkdir } from "node:fs/promises";
import { dirname } from "node:path";
import { fileURLToPath } from "node:url";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const output = process.argv[2] ?? here("dist/report_template.html");

async function bundle(entry) {
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
  return result.outputFiles[0].text.trim();
}

const [script, style, page, license] = await Promise.all([
  bundle("src/main.ts"),
  bundle("src/style.css"),
  readFile(here("src/page.html"), "utf8"),
  readFile(here("node_modules/uplot/LICENSE"), "utf8"),
]);
if (script.includes("</script") || script.includes("<!--"))
  throw new Error("the script would end its own tag");
// As functions, because $ has a meaning in a replacement.
const html = page
  .replace("/*license*/", () => license.trim())
  .replace("/*style*/", () => style)
  .replace("/*script*/", () => script);
await mkdir(dirname(output), { recursive: true });
await writeFile(output, html);
